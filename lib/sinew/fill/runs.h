// SPDX-License-Identifier: GPL-3.0-or-later
// Sets of lattice sites as runs of consecutive sites in a row, and their difference.
//
//     const std::vector<Run> kept = runs_without(inside.runs, near);
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include <sinew/fill/lattice.h>
#include <sinew/fill/row_crossings.h>

namespace sinew {

/// An interval of lengths along an axis; empty where low is above high.
struct Interval {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  bool empty() const { return !(low <= high); }
};

struct Run {
  std::int32_t row, first, last;  ///< sites first .. last - 1
  std::int32_t body;

  int sites() const { return last - first; }
  bool operator==(const Run&) const = default;
};

/// The sites of `runs` that are not in `others`, with their body in `runs`. Both must be sorted by
/// row and then site, without overlaps; so is the result, in which no runs of a body touch.
std::vector<Run> runs_without(const std::vector<Run>& runs, const std::vector<Run>& others);

// The layers, rows and sites of a lattice in an interval of lengths.

/// Integers from first to last - 1.
struct IndexRange {
  int first, last;
};

/// Returns which of 0 .. count - 1 are in the interval, enlarged by a margin above rounding errors.
inline IndexRange fixed_point_units(const Interval& at, int count) {
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
        layers_per_meter_(1 / lattice.unit.z()),
        rows_per_meter_(1 / (across_unit_ * across_step_)),
        sites_per_meter_(1 / (2 * along_unit_)) {}

  Vec3 turned(const Vec3& p) const {
    Vec3 from = p - lattice_.origin;
    if (!diagonal_) return from;
    return {(from.x() + from.y()) * half_root, (from.x() - from.y()) * half_root, from.z()};
  }

  double across(const LatticeLayer& layer, int row) const {
    return across_unit_ * (layer.across + across_step_ * row);
  }
  double up(int layer) const { return lattice_.unit.z() * (lattice_.low[2] + layer); }

  IndexRange layers(const Interval& up) const {
    const auto at = [&](double z) { return z * layers_per_meter_ - lattice_.low[2]; };
    return fixed_point_units({at(up.low), at(up.high)}, static_cast<int>(lattice_.layers.size()));
  }
  IndexRange rows(const LatticeLayer& layer, const Interval& across) const {
    const double first = double(layer.across) / across_step_;
    const auto at = [&](double y) { return y * rows_per_meter_ - first; };
    return fixed_point_units({at(across.low), at(across.high)}, layer.rows);
  }
  IndexRange sites(const LatticeRow& row, const Interval& along) const {
    const double first = 0.5 * (diagonal_ ? row.first[0] + row.first[1] : row.first[0]);
    const auto at = [&](double x) { return x * sites_per_meter_ - first; };
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
  double layers_per_meter_, rows_per_meter_, sites_per_meter_;
};

// The sites of one row, merged from ranges in any order.

class SiteRanges {
 public:
  /// Whether the last range added contains all of `sites`.
  bool has(IndexRange sites) const {
    return !ranges_.empty() && ranges_.back().first <= sites.first &&
           sites.last <= ranges_.back().last;
  }

  void add(IndexRange sites) {
    if (sites.first >= sites.last) return;
    if (!ranges_.empty() && touch(ranges_.back(), sites))
      ranges_.back() = joined(ranges_.back(), sites);
    else
      ranges_.push_back(sites);
  }

  /// Appends runs of body 0, by site, none touching.
  void append_to(std::vector<Run>& runs, std::size_t row) {
    std::sort(ranges_.begin(), ranges_.end(),
              [](const IndexRange& a, const IndexRange& b) { return a.first < b.first; });
    for (std::size_t i = 0; i < ranges_.size();) {
      IndexRange all = ranges_[i++];
      for (; i < ranges_.size() && touch(all, ranges_[i]); ++i) all = joined(all, ranges_[i]);
      runs.push_back({static_cast<std::int32_t>(row), all.first, all.last, 0});
    }
  }

 private:
  static bool touch(IndexRange a, IndexRange b) { return a.first <= b.last && b.first <= a.last; }
  static IndexRange joined(IndexRange a, IndexRange b) {
    return {std::min(a.first, b.first), std::max(a.last, b.last)};
  }

  std::vector<IndexRange> ranges_;
};

// The runs inside a surface, as collected by a sweep along the rows of a lattice.

/// The result for a part of the rows.
struct SweptRows {
  std::vector<Run> runs;
  std::vector<std::array<int, 2>> overlaps;  ///< components that share a site
  int deepest = 0, shallowest = 0;           ///< winding numbers; of closed surfaces only
};

/// Collects runs of one row, without the sites on the surface.
class RowRuns {
 public:
  RowRuns(std::size_t row, const std::vector<RowSite>& on_surface, std::vector<Run>& runs)
      : row_(static_cast<std::int32_t>(row)),
        runs_(runs),
        next_(std::lower_bound(on_surface.begin(), on_surface.end(), RowSite{row_, 0})),
        end_(on_surface.end()) {}

  /// Adds the sites first .. last - 1. Calls must be in the order of the sites.
  void add(int first, int last, int body) {
    while (next_ != end_ && next_->row == row_ && next_->site < last) {
      push(first, next_->site, body);
      first = std::max(first, next_->site + 1);
      ++next_;
    }
    push(first, last, body);
  }

 private:
  void push(int first, int last, int body) {
    if (first >= last) return;
    const bool follows = !runs_.empty() && runs_.back().row == row_ && runs_.back().last == first &&
                         runs_.back().body == body;
    follows ? void(runs_.back().last = last) : runs_.push_back({row_, first, last, body});
  }

  std::int32_t row_;
  std::vector<Run>& runs_;
  std::vector<RowSite>::const_iterator next_, end_;
};

}  // namespace sinew
