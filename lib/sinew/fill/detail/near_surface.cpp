// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/fill/detail/near_surface.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/parallel.h>
#include <sinew/fill/runs.h>

namespace sinew {

namespace {

/// Tilt of a side against the rows that is within rounding: such a side may be left out.
constexpr double no_tilt = 1e-15;

void add(Interval& all, const Interval& part) {
  if (part.empty()) return;
  all = {std::min(all.low, part.low), std::max(all.high, part.high)};
}

/// Keeps those x of the interval for which slope x + offset >= 0.
void keep(Interval& part, double slope, double offset) {
  if (slope > 0)
    part.low = std::max(part.low, -offset / slope);
  else if (slope < 0)
    part.high = std::min(part.high, -offset / slope);
  else if (!(offset >= 0))
    part = {};
}

Interval everything() { return {-HUGE_VAL, HUGE_VAL}; }

/// Returns a normal of length 1, zero for collinear corners. A thin face's has few significant
/// digits, but must not lean along the longest side, where the lever arm is long.
Vec3 unit_normal(const Vec3& edge, const Vec3& next_edge, const Vec3& longest) {
  Vec3 normal = edge.cross(next_edge);
  const double squared_length = longest.squaredNorm();
  if (!(squared_length > 0)) return Vec3::Zero();
  for (int i = 0; i < 2; ++i) normal -= normal.dot(longest) / squared_length * longest;
  const double size = normal.norm();
  if (!(size > 0)) return Vec3::Zero();
  return normal / size;
}

}  // namespace

Interval up_reach(const Corners& corners, double distance) {
  const auto [low, high] = std::minmax({corners[0].z(), corners[1].z(), corners[2].z()});
  return {low - distance, high + distance};
}

Interval across_reach(const Corners& corners, double distance, double low, double high) {
  low -= distance;
  high += distance;
  Interval reach;
  for (int i = 0; i < 3; ++i) {
    const Vec3 &a = corners[i], &b = corners[(i + 1) % 3];
    Interval part{0, 1};  // range along the side, 0 to 1
    keep(part, b.z() - a.z(), a.z() - low);
    keep(part, a.z() - b.z(), high - a.z());
    if (part.empty()) continue;
    const double run = b.y() - a.y(), from = a.y() + run * part.low, to = a.y() + run * part.high;
    add(reach, {std::min(from, to) - distance, std::max(from, to) + distance});
  }
  return reach;
}

DilatedTriangle::DilatedTriangle(const Corners& corners, double distance)
    : corners_(corners),
      middle_((corners[0] + corners[1] + corners[2]) / 3),
      distance_(distance),
      squared_distance_(distance * distance) {
  const Corners edges = {corners[1] - corners[0], corners[2] - corners[1], corners[0] - corners[2]};
  for (int i = 1; i < 3; ++i)
    if (edges[i].squaredNorm() > edges[longest_].squaredNorm()) longest_ = i;
  normal_ = unit_normal(edges[0], edges[1], edges[longest_]);
  double bound = 0;
  for (int i = 0; i < 3; ++i) {
    sides_[i] = side(edges[i], normal_);
    bound = std::max(bound, (corners[i] - middle_).squaredNorm());
  }
  bound_ = (std::sqrt(bound) + distance) * (1 + 1e-12);
}

DilatedTriangle::Side DilatedTriangle::side(const Vec3& edge, const Vec3& normal) {
  Side side{edge, normal.cross(edge), 0, 0, 0, 0, edge.squaredNorm()};
  const double squared_flat = edge.y() * edge.y() + edge.z() * edge.z();
  if (squared_flat <= no_tilt * no_tilt * side.squared_length) return side;
  const double inverse = 1 / std::sqrt(squared_flat);
  side.across = edge.y() * inverse;
  side.up = edge.z() * inverse;
  side.slope = edge.x() * inverse;
  side.stretch = std::sqrt(side.squared_length) * inverse;
  return side;
}

Interval DilatedTriangle::along(double across, double up) const {
  Interval all;
  Corners from;  // offsets from the corners to the row's point at which `along` equals the corner's
  for (int i = 0; i < 3; ++i)
    from[i] = {-corners_[i].x(), across - corners_[i].y(), up - corners_[i].z()};
  for (int i = 0; i < 3; ++i) {
    add_ball(from[i], corners_[i].x(), all);
    add_cylinder(sides_[i], from[i], corners_[i].x(), all);
  }
  add_slab(from, all);
  return all;
}

void DilatedTriangle::add_ball(const Vec3& from, double along, Interval& all) const {
  const double left = squared_distance_ - from.y() * from.y() - from.z() * from.z();
  if (left < 0) return;
  const double half = std::sqrt(left);
  add(all, {along - half, along + half});
}

/// Keeps the part between the planes normal to a side at its ends; x counts from `shift` before
/// its corner.
void DilatedTriangle::keep_beside(const Side& side, const Vec3& from, double shift,
                                  Interval& part) {
  const double beside = shift * side.edge.x() + from.y() * side.edge.y() + from.z() * side.edge.z();
  keep(part, side.edge.x(), beside);
  keep(part, -side.edge.x(), side.squared_length - beside);
}

/// With x along the row from the side's corner, t the position beside the side and h the distance
/// from its line, both in projection: |x - slope t| <= stretch sqrt(d^2 - h^2), cut at both ends.
void DilatedTriangle::add_cylinder(const Side& side, const Vec3& from, double along,
                                   Interval& all) const {
  if (side.squared_length == 0) return;
  Interval part = everything();
  if (side.stretch > 0) {
    const double h = from.y() * side.up - from.z() * side.across;
    const double left = squared_distance_ - h * h;
    if (left < 0) return;
    const double center = side.slope * (from.y() * side.across + from.z() * side.up);
    const double half = side.stretch * std::sqrt(left);
    part = {center - half, center + half};
  } else if (from.y() * from.y() + from.z() * from.z() > squared_distance_) {
    return;
  }
  keep_beside(side, from, 0, part);
  add(all, {along + part.low, along + part.high});
}

void DilatedTriangle::add_slab(const Corners& from, Interval& all) const {
  if (normal_.isZero(0)) return;
  Interval part = everything();
  const double above = from[0].y() * normal_.y() + from[0].z() * normal_.z();
  keep(part, normal_.x(), distance_ + above);
  keep(part, -normal_.x(), distance_ - above);
  const auto shift = [&](int i) { return corners_[0].x() - corners_[i].x(); };
  for (int i = 0; i < 3 && !part.empty(); ++i) {
    const Vec3& inward = sides_[i].inward;
    keep(part, inward.x(),
         inward.x() * shift(i) + from[i].y() * inward.y() + from[i].z() * inward.z());
  }
  // The sides of a face without area are parallel, so the slab would be unbounded.
  keep_beside(sides_[longest_], from[longest_], shift(longest_), part);
  add(all, {corners_[0].x() + part.low, corners_[0].x() + part.high});
}

Interval DilatedTriangle::along_at_most(double across, double up) const {
  const double y = across - middle_.y(), z = up - middle_.z();
  const double left = bound_ * bound_ - y * y - z * z;
  if (left < 0) return {};
  const double half = std::sqrt(left), above = y * normal_.y() + z * normal_.z();
  const double reach = distance_ + 1e-12 * bound_;
  Interval part{-half, half};
  keep(part, normal_.x(), reach + above);
  keep(part, -normal_.x(), reach - above);
  return {middle_.x() + part.low, middle_.x() + part.high};
}

namespace {

constexpr int tile_edge = 16;  // layers, and rows of each
constexpr std::size_t faces_per_task = 1024, points_per_task = 8192;

/// Divides the rows into tiles, so that working memory stays small and each row belongs to one
/// thread. All faces that may meet a tile's rows are assigned to it first.
class Rasterizer {
 public:
  Rasterizer(const Lattice& lattice, const Triangles& surface, double distance)
      : lattice_(lattice),
        surface_(surface),
        rows_(lattice),
        distance_(distance),
        tiles_up_(tiles(static_cast<int>(lattice.layers.size()))),
        tiles_across_(tiles(max_rows(lattice))),
        points_(surface.points.size()) {
    turn_points();
    sort_into_tiles();
  }

  std::vector<Run> all_runs() const {
    std::vector<std::vector<Run>> found(first_.size() - 1);
    parallel_for(found.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t tile = begin; tile < end; ++tile) found[tile] = runs_of(tile);
    });
    return in_order(found);
  }

 private:
  struct Meeting {
    int tile, face;
  };

  static int tiles(int rows) { return (rows + tile_edge - 1) / tile_edge; }
  static int max_rows(const Lattice& lattice) {
    int most = 0;
    for (const LatticeLayer& layer : lattice.layers) most = std::max(most, layer.rows);
    return most;
  }

  Corners corners(int face) const {
    const auto& [a, b, c] = surface_.faces[face];
    return {points_[a], points_[b], points_[c]};
  }

  void turn_points() {
    parallel_for(points_.size(), points_per_task, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) points_[i] = rows_.turned(surface_.points[i]);
    });
  }

  void sort_into_tiles() {
    const std::size_t faces = surface_.faces.size();
    std::vector<std::vector<Meeting>> meetings((faces + faces_per_task - 1) / faces_per_task);
    parallel_for(faces, faces_per_task, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        put_down(static_cast<int>(i), meetings[begin / faces_per_task]);
    });
    first_.assign(std::size_t(tiles_up_) * tiles_across_ + 1, 0);
    for (const auto& piece : meetings)
      for (const Meeting& one : piece) ++first_[one.tile + 1];
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    faces_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (const auto& piece : meetings)
      for (const Meeting& one : piece) faces_[next[one.tile]++] = one.face;
  }

  void put_down(int face, std::vector<Meeting>& meetings) const {
    const Corners at = corners(face);
    const IndexRange layers = rows_.layers(up_reach(at, distance_));
    for (int layer = layers.first; layer < layers.last;) {
      const int tile_up = layer / tile_edge, end = std::min((tile_up + 1) * tile_edge, layers.last);
      const Interval across = across_reach(at, distance_, rows_.up(layer), rows_.up(end - 1));
      const IndexRange rows = rows_.rows(lattice_.layers[layer], across);  // in the others one off
      const int last = std::min(rows.last / tile_edge, tiles_across_ - 1);
      for (int tile = std::max(0, rows.first - 1) / tile_edge; tile <= last; ++tile)
        meetings.push_back({tile_up * tiles_across_ + tile, face});
      layer = end;
    }
  }

  std::vector<Run> runs_of(std::size_t tile) const {
    std::vector<Run> runs;
    if (first_[tile] == first_[tile + 1]) return runs;
    const int layer = static_cast<int>(tile) / tiles_across_ * tile_edge,
              row = static_cast<int>(tile) % tiles_across_ * tile_edge;
    std::vector<SiteRanges> found(std::size_t{tile_edge} * tile_edge);
    for (std::size_t i = first_[tile]; i < first_[tile + 1]; ++i)
      rasterize(corners(faces_[i]), layer, row, found);
    for (int i = 0; i < tile_edge * tile_edge; ++i) {
      const int l = layer + i / tile_edge;
      if (l < static_cast<int>(lattice_.layers.size()))
        found[i].append_to(runs, lattice_.layers[l].first_row + row + i % tile_edge);
    }
    return runs;
  }

  void rasterize(const Corners& at, int first_layer, int first_row,
                 std::vector<SiteRanges>& found) const {
    const DilatedTriangle body(at, distance_);
    const IndexRange layers = rows_.layers(up_reach(at, distance_));
    const int end = std::min(first_layer + tile_edge, layers.last);
    for (int layer = std::max(first_layer, layers.first); layer < end; ++layer) {
      const LatticeLayer& in = lattice_.layers[layer];
      const double up = rows_.up(layer);
      const IndexRange rows = rows_.rows(in, across_reach(at, distance_, up, up));
      const int last = std::min(first_row + tile_edge, rows.last);
      for (int row = std::max(first_row, rows.first); row < last; ++row)
        meet(body, lattice_.rows[in.first_row + row], rows_.across(in, row), up,
             found[(layer - first_layer) * tile_edge + row - first_row]);
    }
  }

  void meet(const DilatedTriangle& body, const LatticeRow& row, double across, double up,
            SiteRanges& found) const {
    const IndexRange most = rows_.sites(row, body.along_at_most(across, up));
    if (most.first >= most.last || found.has(most)) return;
    found.add(rows_.sites(row, body.along(across, up)));
  }

  /// Counts, then fills: a row's runs all come from one tile.
  std::vector<Run> in_order(const std::vector<std::vector<Run>>& found) const {
    std::vector<std::size_t> next(lattice_.rows.size() + 1, 0);
    for (const auto& tile : found)
      for (const Run& run : tile) ++next[run.row + 1];
    for (std::size_t i = 1; i < next.size(); ++i) next[i] += next[i - 1];
    std::vector<Run> runs(next.back());
    for (const auto& tile : found)
      for (const Run& run : tile) runs[next[run.row]++] = run;
    return runs;
  }

  const Lattice& lattice_;
  const Triangles& surface_;
  RowRanges rows_;
  double distance_;
  int tiles_up_, tiles_across_;
  Points points_;                   ///< points of the surface, in the lattice's axes
  std::vector<std::size_t> first_;  ///< index of each tile's first face, and the total number
  std::vector<int> faces_;
};

}  // namespace

std::vector<Run> runs_near(const Lattice& lattice, const Triangles& surface, double distance) {
  return Rasterizer(lattice, surface, distance).all_runs();
}

}  // namespace sinew
