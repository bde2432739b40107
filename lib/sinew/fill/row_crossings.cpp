// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/fill/row_crossings.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include <sinew/core/parallel.h>
#include <sinew/fill/detail/exact.h>

namespace sinew {

namespace {

int sign(double x) { return (x > 0) - (x < 0); }

}  // namespace

RowSide::RowSide(const Lattice& lattice, double largest)
    : lattice_(lattice), frame_(lattice), extent_(2 * largest) {}

int RowSide::exact(const Vec3& a, const Vec3& b, const LatticeRow& row) const {
  return frame_.handedness() *
         exact::orientation(a, b, lattice_.site(row, 0), lattice_.site(row, 1));
}

int RowSide::shifted(const Vec3& a, const Vec3& b) const {
  if (a.z() != b.z()) return sign(a.z() - b.z());
  if (!frame_.diagonal()) return sign(b.y() - a.y());
  const double run = (b.x() - a.x()) - (b.y() - a.y());
  return std::abs(run) > 8 * rounding * extent_
             ? sign(run)
             : exact::compare_differences(a.x(), b.x(), a.y(), b.y());
}

double largest_coordinate(const Lattice& lattice, const Points& points) {
  double largest = lattice.origin.cwiseAbs().maxCoeff();
  for (const Vec3& p : points) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  return largest;
}

namespace {

constexpr std::size_t faces_at_a_time = 4096, rows_per_sort = 512;

/// A point of the surface in the frame of the rows.
struct Corner {
  double x, across, up;
};

struct RowCrossing {
  std::int32_t row;
  Crossing crossing;
};

/// The result for a part of the faces.
struct Found {
  std::vector<RowCrossing> crossings;
  std::vector<RowSite> on_surface;
};

struct Reach {
  double low, high;
};

/// A row as a point relative to a face's corners, on the left or right of each side.
struct Sides {
  std::array<int, 3> sign;         ///< exact; 0: on the side's line
  std::array<double, 3> leverage;  ///< barycentric weight of the corner opposite to each side
  double tolerance;                ///< tolerance of the sum of weights
};

class Caster {
 public:
  Caster(const Lattice& lattice, const Triangles& surface)
      : lattice_(lattice),
        surface_(surface),
        frame_(lattice),
        side_(lattice, largest_coordinate(lattice, surface.points)),
        corners_(surface.points.size()) {
    parallel_for(corners_.size(), faces_at_a_time, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Vec3& p = surface_.points[i];
        corners_[i] = {p.x(), frame_.across(p), p.z()};
      }
    });
  }

  /// Finds all rows that cross a face, or touch it at a site.
  void cast(int face, Found& found) const {
    const auto [low, high] = up_reach(face);
    const int last = static_cast<int>(lattice_.layers.size()) - 1;
    const int from = first_index(frame_.layer_at(low), last),
              to = last_index(frame_.layer_at(high), last);
    for (int layer = from; layer <= to; ++layer) {
      const LatticeLayer& rows = lattice_.layers[layer];
      const auto [left, right] = across_reach(face, frame_.layer_up(layer));
      const int end = last_index(frame_.row_at(rows, right), rows.rows - 1);
      for (int row = first_index(frame_.row_at(rows, left), rows.rows - 1); row <= end; ++row)
        meet(face, {layer, row}, found);
    }
  }

 private:
  struct Place {
    int layer, row;
  };

  // Integers from `at` on, and up to it, enlarged by a margin above rounding errors.
  static int first_index(double at, int last) {
    return static_cast<int>(std::ceil(std::clamp(at - 1e-6, 0.0, last + 1.0)));
  }
  static int last_index(double at, int last) {
    return static_cast<int>(std::floor(std::clamp(at + 1e-6, -1.0, last + 0.0)));
  }

  const Corner& corner(int face, int which) const {
    return corners_[surface_.faces[face][which % 3]];
  }
  const Vec3& point(int face, int which) const {
    return surface_.points[surface_.faces[face][which % 3]];
  }

  Reach up_reach(int face) const {
    const auto [low, high] =
        std::minmax({corner(face, 0).up, corner(face, 1).up, corner(face, 2).up});
    return {low, high};
  }

  /// Bounds on where a face can be met at height `up`; may be too large.
  Reach across_reach(int face, double up) const {
    Reach reach{HUGE_VAL, -HUGE_VAL};
    for (int side = 0; side < 3; ++side) {
      const Corner &a = corner(face, side), &b = corner(face, side + 1);
      const auto [low, high] = std::minmax(a.up, b.up);
      if (up < low - 8 * rounding * side_.extent() || up > high + 8 * rounding * side_.extent())
        continue;
      const double rise = high - low, run = b.across - a.across;
      const double pad = 8 * rounding * side_.extent();
      if (pad * (rise + std::abs(run)) < rise * std::abs(run)) {
        const double slip = pad * (1 + std::abs(run) / rise);
        const double at = a.across + run * std::clamp((up - a.up) / (b.up - a.up), 0.0, 1.0);
        reach = {std::min(reach.low, at - slip), std::max(reach.high, at + slip)};
      } else {  // nearly level
        const auto [left, right] = std::minmax(a.across, b.across);
        reach = {std::min(reach.low, left - pad), std::max(reach.high, right + pad)};
      }
    }
    return reach;
  }

  Sides sides(int face, const LatticeRow& row, double across, double up) const {
    Sides sides{{}, {}, 0};
    for (int side = 0; side < 3; ++side) {
      const Corner &a = corner(face, side), &b = corner(face, side + 1);
      const double ax = a.across - across, bx = b.across - across, ay = a.up - up, by = b.up - up;
      const double area = ax * by - bx * ay;
      const double tolerance = 16 * rounding * side_.extent() *
                               (std::abs(ax) + std::abs(ay) + std::abs(bx) + std::abs(by));
      sides.tolerance += tolerance;
      sides.leverage[side] = std::abs(area);
      sides.sign[side] = std::abs(area) > tolerance
                             ? sign(area)
                             : side_.exact(point(face, side), point(face, side + 1), row);
    }
    return sides;
  }

  void meet(int face, Place place, Found& found) const {
    const LatticeLayer& layer = lattice_.layers[place.layer];
    const std::size_t index = layer.first_row + place.row;
    const LatticeRow& row = lattice_.rows[index];
    const Sides at =
        sides(face, row, frame_.row_across(layer, place.row), frame_.layer_up(place.layer));
    const auto [least, most] = std::minmax({at.sign[0], at.sign[1], at.sign[2]});
    if (least < 0 && most > 0) return;
    if (least == most && most == 0) return touch(face, index, found);
    const int turn = least + most > 0 ? 1 : -1;  // seen along the row
    const int site = first_beyond(face, index, at, turn, found);
    for (int side = 0; side < 3; ++side)
      if (at.sign[side] == 0 && side_.shifted(point(face, side), point(face, side + 1)) != turn)
        return;
    found.crossings.push_back(
        {static_cast<std::int32_t>(index), {site, face, -turn * frame_.handedness()}});
  }

  /// The row lies in the face's plane: only sites on the face count.
  void touch(int face, std::size_t index, Found& found) const {
    const LatticeRow& row = lattice_.rows[index];
    const auto [low, high] = site_reach(face, row);
    for (int n = low; n <= high; ++n)
      if (exact::on_triangle(point(face, 0), point(face, 1), point(face, 2), lattice_.site(row, n)))
        found.on_surface.push_back({static_cast<std::int32_t>(index), n});
  }

  /// The sites of the row in the face's extent along it, enlarged by a few.
  std::pair<int, int> site_reach(int face, const LatticeRow& row) const {
    const auto [low, high] = std::minmax({corner(face, 0).x, corner(face, 1).x, corner(face, 2).x});
    return {first_index(frame_.site_at(row, low) - 1, row.sites - 1),
            last_index(frame_.site_at(row, high) + 1, row.sites - 1)};
  }

  /// The row's first site at or beyond its crossing with the face; a site on the face is recorded.
  int first_beyond(int face, std::size_t index, const Sides& at, int turn, Found& found) const {
    const LatticeRow& row = lattice_.rows[index];
    const double area = at.leverage[0] + at.leverage[1] + at.leverage[2];
    auto [low, high] = site_reach(face, row);
    if (area > 4 * at.tolerance) {
      const double xa = corner(face, 0).x, xb = corner(face, 1).x, xc = corner(face, 2).x;
      const double x =  // the corner opposite to side 0 is the third
          (at.leverage[0] * xc + at.leverage[1] * xa + at.leverage[2] * xb) / area;
      const auto [least, most] = std::minmax({xa, xb, xc});
      const double slip =
          (2 * at.tolerance / area * (most - least) + 16 * rounding * side_.extent()) /
          frame_.site_step();
      const double where = frame_.site_at(row, x);
      if (std::abs(where - std::round(where)) > slip)
        return first_index(where + 1e-6, row.sites - 1);
      low = std::max(low, first_index(where - slip, row.sites - 1));
      high = std::min(high, last_index(where + slip, row.sites - 1));
    }
    return search(face, index, {low, high}, turn * frame_.handedness(), found);
  }

  /// Bisects the sites low .. high, of which those beyond the face's plane follow the others.
  int search(int face, std::size_t index, std::pair<int, int> sites, int facing,
             Found& found) const {
    const LatticeRow& row = lattice_.rows[index];
    auto [low, high] = sites;
    const int end = high;
    ++high;
    const auto beyond = [&](int n) {
      return facing * exact::orientation(point(face, 0), point(face, 1), point(face, 2),
                                         lattice_.site(row, n));
    };
    while (low < high) {
      const int middle = low + (high - low) / 2;
      beyond(middle) >= 0 ? high = middle : low = middle + 1;
    }
    if (low <= end && beyond(low) == 0)
      found.on_surface.push_back({static_cast<std::int32_t>(index), low});
    return low;
  }

  const Lattice& lattice_;
  const Triangles& surface_;
  RowFrame frame_;
  RowSide side_;
  std::vector<Corner> corners_;
};

std::vector<Found> cast_all(const Lattice& lattice, const Triangles& surface) {
  const std::size_t faces = surface.faces.size();
  std::vector<Found> found((faces + faces_at_a_time - 1) / faces_at_a_time);
  const Caster caster(lattice, surface);
  parallel_for(faces, faces_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      caster.cast(static_cast<int>(i), found[begin / faces_at_a_time]);
  });
  return found;
}

/// Counts, then fills: sorting determines the order in a row.
void sort_into_rows(const std::vector<Found>& found, RowCrossings& rows) {
  for (const Found& piece : found)
    for (const RowCrossing& one : piece.crossings) ++rows.first[one.row + 1];
  for (std::size_t row = 1; row < rows.first.size(); ++row) rows.first[row] += rows.first[row - 1];
  rows.crossings.resize(rows.first.back());
  std::vector<std::size_t> next(rows.first.begin(), rows.first.end() - 1);
  for (const Found& piece : found)
    for (const RowCrossing& one : piece.crossings) rows.crossings[next[one.row]++] = one.crossing;
  parallel_for(next.size(), rows_per_sort, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row)
      std::sort(rows.crossings.begin() + rows.first[row],
                rows.crossings.begin() + rows.first[row + 1],
                [](const Crossing& a, const Crossing& b) {
                  return std::tie(a.site, a.face) < std::tie(b.site, b.face);
                });
  });
}

}  // namespace

RowCrossings row_crossings(const Lattice& lattice, const Triangles& surface) {
  RowCrossings rows;
  rows.first.assign(lattice.rows.size() + 1, 0);
  const std::vector<Found> found = cast_all(lattice, surface);
  sort_into_rows(found, rows);
  for (const Found& piece : found)
    rows.on_surface.insert(rows.on_surface.end(), piece.on_surface.begin(), piece.on_surface.end());
  std::sort(rows.on_surface.begin(), rows.on_surface.end());
  rows.on_surface.erase(std::unique(rows.on_surface.begin(), rows.on_surface.end()),
                        rows.on_surface.end());
  return rows;
}

void add_crossings(const RowCrossings& others, int first_face, RowCrossings& all) {
  RowCrossings sum{{0}, {}, std::move(all.on_surface)};
  for (std::size_t row = 0; row + 1 < all.first.size(); ++row) {
    const auto ours = all.of(row), theirs = others.of(row);
    const auto begin = static_cast<std::ptrdiff_t>(sum.crossings.size());
    sum.crossings.insert(sum.crossings.end(), ours.begin(), ours.end());
    for (const Crossing& one : theirs)
      sum.crossings.push_back({one.site, first_face + one.face, one.winding});
    std::inplace_merge(sum.crossings.begin() + begin,
                       sum.crossings.begin() + begin + static_cast<std::ptrdiff_t>(ours.size()),
                       sum.crossings.end(),
                       [](const Crossing& a, const Crossing& b) { return a.site < b.site; });
    sum.first.push_back(sum.crossings.size());
  }
  all = std::move(sum);
}

}  // namespace sinew
