// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/volume/tensor_lines.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <tuple>
#include <unordered_map>

#include <sinew/core/decompositions.h>
#include <sinew/core/error.h>

namespace sinew {
namespace {

constexpr std::uint32_t no_cell = std::numeric_limits<std::uint32_t>::max();
constexpr double steps_per_spacing = 8;
constexpr double sharpest_turn = 0.7;  // cosine between steps: beyond, the direction is not defined
constexpr std::size_t max_seeds = 100'000;

/// For each cell the cells behind its faces, a face being named by the vertex opposite to it.
std::vector<std::array<std::uint32_t, 4>> neighbors_of(std::span<const Cell> cells) {
  struct CellFace {
    std::array<std::uint32_t, 3> points;
    std::uint32_t cell, opposite;
  };
  std::vector<CellFace> faces;
  faces.reserve(4 * cells.size());
  for (std::uint32_t c = 0; c < cells.size(); ++c)
    for (std::uint32_t k = 0; k < 4; ++k) {
      CellFace face{{cells[c][(k + 1) % 4], cells[c][(k + 2) % 4], cells[c][(k + 3) % 4]}, c, k};
      std::sort(face.points.begin(), face.points.end());
      faces.push_back(face);
    }
  std::sort(faces.begin(), faces.end(), [](const CellFace& a, const CellFace& b) {
    return std::tie(a.points, a.cell) < std::tie(b.points, b.cell);
  });
  std::vector<std::array<std::uint32_t, 4>> neighbors(cells.size(),
                                                      {no_cell, no_cell, no_cell, no_cell});
  for (std::size_t i = 1; i < faces.size(); ++i) {
    const CellFace &a = faces[i - 1], &b = faces[i];
    if (a.points != b.points) continue;
    neighbors[a.cell][a.opposite] = b.cell;
    neighbors[b.cell][b.opposite] = a.cell;
  }
  return neighbors;
}

/// A tensor field in cells, looked up by walking from a cell nearby.
class TensorField {
 public:
  TensorField(const Points& points, std::span<const Cell> cells,
              const std::vector<SymmetricTensor>& tensors)
      : points_(points), cells_(cells), tensors_(tensors), neighbors_(neighbors_of(cells)) {}

  Vec3 middle_of(std::uint32_t cell) const {
    Vec3 sum = Vec3::Zero();
    for (const std::uint32_t point : cells_[cell]) sum += points_[point];
    return sum / 4;
  }

  /// None outside of the cells; else `cell` becomes the one around the place.
  std::optional<LargestPrincipal> at(const Vec3& place, std::uint32_t& cell) const {
    constexpr int longest_walk = 200;  // cells
    for (int walked = 0; walked < longest_walk && cell != no_cell; ++walked) {
      const std::optional<std::array<double, 4>> weights = weights_in(cell, place);
      if (!weights) return std::nullopt;
      const auto least = std::min_element(weights->begin(), weights->end());
      if (*least >= -1e-9) return principal(cell, *weights);
      cell = neighbors_[cell][static_cast<std::size_t>(least - weights->begin())];
    }
    return std::nullopt;
  }

 private:
  /// Barycentric coordinates; none in a cell that is inside out or flat.
  std::optional<std::array<double, 4>> weights_in(std::uint32_t cell, const Vec3& place) const {
    const double volume = volume_of(points_, cells_[cell]);
    if (!(volume > 0)) return std::nullopt;
    std::array<Vec3, 4> corners;
    for (std::size_t k = 0; k < 4; ++k) corners[k] = points_[cells_[cell][k]];
    std::array<double, 4> weights;
    for (std::size_t k = 0; k < 4; ++k) {
      std::array<Vec3, 4> moved = corners;
      moved[k] = place;
      weights[k] =
          (moved[1] - moved[0]).cross(moved[2] - moved[0]).dot(moved[3] - moved[0]) / (6 * volume);
    }
    return weights;
  }

  std::optional<LargestPrincipal> principal(std::uint32_t cell,
                                            const std::array<double, 4>& weights) const {
    SymmetricTensor mean{};
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t c = 0; c < 6; ++c) mean[c] += weights[k] * tensors_[cells_[cell][k]][c];
    for (const double part : mean)
      if (!std::isfinite(part)) return std::nullopt;
    return largest_principal(mean);
  }

  const Points& points_;
  std::span<const Cell> cells_;
  const std::vector<SymmetricTensor>& tensors_;
  std::vector<std::array<std::uint32_t, 4>> neighbors_;
};

/// The points of lines drawn so far.
class Occupied {
 public:
  explicit Occupied(double spacing) : spacing_(spacing) {}

  bool is_near(const Vec3& place, double distance) const {
    const std::array<std::int64_t, 3> here = box_of(place);
    for (std::int64_t x = -1; x <= 1; ++x)
      for (std::int64_t y = -1; y <= 1; ++y)
        for (std::int64_t z = -1; z <= 1; ++z) {
          const auto box = boxes_.find(key({here[0] + x, here[1] + y, here[2] + z}));
          if (box == boxes_.end()) continue;
          for (const Vec3& point : box->second)
            if ((point - place).squaredNorm() < distance * distance) return true;
        }
    return false;
  }

  void add(const TensorLine& line) {
    for (const Vec3& point : line.points) boxes_[key(box_of(point))].push_back(point);
  }

 private:
  std::array<std::int64_t, 3> box_of(const Vec3& place) const {
    std::array<std::int64_t, 3> box;
    for (int axis = 0; axis < 3; ++axis)
      box[axis] = static_cast<std::int64_t>(std::floor(place[axis] / spacing_));
    return box;
  }

  /// Equal keys of different boxes cost time alone: distances decide.
  static std::uint64_t key(const std::array<std::int64_t, 3>& box) {
    std::uint64_t mixed = 0;
    for (const std::int64_t part : box)
      mixed = (mixed ^ static_cast<std::uint64_t>(part)) * 0x9E3779B97F4A7C15U;
    return mixed;
  }

  double spacing_;
  std::unordered_map<std::uint64_t, Points> boxes_;
};

class Tracer {
 public:
  Tracer(const TensorField& field, const Occupied& others, const TensorLineOptions& options)
      : field_(field), others_(others), options_(options) {}

  /// Through the middle of the cell, in both directions.
  TensorLine through(std::uint32_t cell) const {
    const Vec3 begin = field_.middle_of(cell);
    std::uint32_t around = cell;
    const std::optional<LargestPrincipal> first = field_.at(begin, around);
    if (!first || first->value < options_.min_value) return {};
    TensorLine line = along(begin, -first->direction, cell);
    std::reverse(line.points.begin(), line.points.end());
    std::reverse(line.values.begin(), line.values.end());
    line.points.push_back(begin);
    line.values.push_back(first->value);
    const TensorLine ahead = along(begin, first->direction, cell);
    line.points.insert(line.points.end(), ahead.points.begin(), ahead.points.end());
    line.values.insert(line.values.end(), ahead.values.begin(), ahead.values.end());
    return line;
  }

 private:
  /// Steps by the midpoint rule, without the first point; once around where the line is closed.
  TensorLine along(const Vec3& begin, Vec3 direction, std::uint32_t cell) const {
    const double step = options_.spacing / steps_per_spacing;
    TensorLine line;
    Vec3 place = begin;
    while (line.points.size() < options_.max_points / 2) {
      if (!turn_to(field_.at(place, cell), direction) ||
          !turn_to(field_.at(place + step / 2 * direction, cell), direction))
        break;
      place += step * direction;
      const std::optional<LargestPrincipal> here = field_.at(place, cell);
      if (!here || here->value < options_.min_value || is_taken(place)) break;
      line.points.push_back(place);
      line.values.push_back(here->value);
      if (line.points.size() > 4 && (place - begin).norm() < step) break;
    }
    return line;
  }

  bool is_taken(const Vec3& place) const { return others_.is_near(place, options_.spacing / 2); }

  /// Eigenvectors have no sign; false where there is none, or the turn would be too sharp.
  static bool turn_to(const std::optional<LargestPrincipal>& principal, Vec3& direction) {
    if (!principal) return false;
    const double cosine = principal->direction.dot(direction);
    if (std::abs(cosine) < sharpest_turn) return false;
    direction = (cosine < 0 ? -1 : 1) * principal->direction;
    return true;
  }

  const TensorField& field_;
  const Occupied& others_;
  const TensorLineOptions& options_;
};

/// Cells with the largest values first.
std::vector<std::uint32_t> seeds_in(std::span<const Cell> cells,
                                    const std::vector<SymmetricTensor>& tensors, double min_value) {
  struct Seed {
    double value;
    std::uint32_t cell;
  };
  std::vector<Seed> seeds;
  const std::size_t stride = 1 + cells.size() / max_seeds;
  for (std::size_t c = 0; c < cells.size(); c += stride) {
    SymmetricTensor mean{};
    for (const std::uint32_t point : cells[c])
      for (std::size_t k = 0; k < 6; ++k) mean[k] += tensors[point][k] / 4;
    const double value = largest_principal(mean).value;
    if (value >= min_value) seeds.push_back({value, static_cast<std::uint32_t>(c)});
  }
  std::sort(seeds.begin(), seeds.end(), [](const Seed& a, const Seed& b) {
    return std::tie(b.value, a.cell) < std::tie(a.value, b.cell);
  });
  std::vector<std::uint32_t> order;
  order.reserve(seeds.size());
  for (const Seed& seed : seeds) order.push_back(seed.cell);
  return order;
}

}  // namespace

LargestPrincipal largest_principal(const SymmetricTensor& tensor) {
  const auto& [xx, yy, zz, xy, yz, xz] = tensor;
  if (!std::isfinite(xx + yy + zz + xy + yz + xz))
    return {std::numeric_limits<double>::quiet_NaN(), Vec3::UnitX()};
  Mat3 matrix;
  matrix << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  const auto [values, axes] = principal_axes(matrix);
  return {values[2], axes.col(2)};
}

std::vector<TensorLine> tensor_lines(const Points& points, std::span<const Cell> cells,
                                     const std::vector<SymmetricTensor>& tensors,
                                     const TensorLineOptions& options) {
  if (!(options.spacing > 0))
    throw bad_input("lines of a tensor need a distance from each other", "give one above zero");
  const TensorField field(points, cells, tensors);
  Occupied occupied(options.spacing);
  const Tracer tracer(field, occupied, options);
  std::vector<TensorLine> lines;
  for (const std::uint32_t cell : seeds_in(cells, tensors, options.min_value)) {
    if (lines.size() == options.max_lines) break;
    if (occupied.is_near(field.middle_of(cell), options.spacing)) continue;
    TensorLine line = tracer.through(cell);
    if (static_cast<double>(line.points.size()) <= steps_per_spacing) continue;
    occupied.add(line);
    lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace sinew
