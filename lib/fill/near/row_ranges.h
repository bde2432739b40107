// SPDX-License-Identifier: GPL-3.0-or-later
// Which layers, rows and sites of a lattice lie within an interval of lengths.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fill/lattice.h"
#include "fill/near/dilated_triangle.h"

namespace sinew {

/// Whole numbers from first to last - 1.
struct IndexRange {
  int first, last;
};

/// Those within the interval and 0 .. count - 1; a little more than rounding asks for.
inline IndexRange whole_numbers(const Interval& at, int count) {
  return {static_cast<int>(std::ceil(std::clamp(at.low - 1e-6, 0.0, count + 0.0))),
          static_cast<int>(std::floor(std::clamp(at.high + 1e-6, -1.0, count - 1.0))) + 1};
}

/// The lattice in axes (along, across, up) relative to its origin.
class RowRanges {
 public:
  explicit RowRanges(const Lattice& lattice)
      : lattice_(lattice),
        diagonal_(lattice.packing == Packing::fcc),
        along_unit_(lattice.unit.x() * (diagonal_ ? half_root : 1)),
        across_unit_(diagonal_ ? along_unit_ : lattice.unit.y()),
        across_step_(diagonal_ ? 2 : 3),
        layers_per_metre_(1 / lattice.unit.z()),
        rows_per_metre_(1 / (across_unit_ * across_step_)),
        sites_per_metre_(1 / (2 * along_unit_)) {}

  Vec3 turned(const Vec3& p) const {
    const Vec3 from = p - lattice_.origin;
    if (!diagonal_) return from;
    return {(from.x() + from.y()) * half_root, (from.x() - from.y()) * half_root, from.z()};
  }

  double across(const LatticeLayer& layer, int row) const {
    return across_unit_ * (layer.across + across_step_ * row);
  }
  double up(int layer) const { return lattice_.unit.z() * (lattice_.low[2] + layer); }

  IndexRange layers(const Interval& up) const {
    const auto at = [&](double z) { return z * layers_per_metre_ - lattice_.low[2]; };
    return whole_numbers({at(up.low), at(up.high)}, static_cast<int>(lattice_.layers.size()));
  }
  IndexRange rows(const LatticeLayer& layer, const Interval& across) const {
    const double first = double(layer.across) / across_step_;
    const auto at = [&](double y) { return y * rows_per_metre_ - first; };
    return whole_numbers({at(across.low), at(across.high)}, layer.rows);
  }
  IndexRange sites(const LatticeRow& row, const Interval& along) const {
    const double first = 0.5 * (diagonal_ ? row.first[0] + row.first[1] : row.first[0]);
    const auto at = [&](double x) { return x * sites_per_metre_ - first; };
    const double low = std::clamp(at(along.low), 0.0, row.sites + 0.0),
                 high = std::clamp(at(along.high), -1.0, row.sites - 1.0);
    return {static_cast<int>(std::ceil(low)), static_cast<int>(std::floor(high)) + 1};
  }

 private:
  static constexpr double half_root = std::numbers::sqrt2 / 2;

  const Lattice& lattice_;
  bool diagonal_;
  double along_unit_, across_unit_;
  int across_step_;
  double layers_per_metre_, rows_per_metre_, sites_per_metre_;
};

}  // namespace sinew
