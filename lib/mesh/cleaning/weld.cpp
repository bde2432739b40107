// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/cleaning/weld.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "mesh/cleaning/first_of.h"

namespace sinew {
namespace {

std::uint64_t hash_of(const Vec3& p) {
  std::uint64_t hash = 0;
  for (const double x : p) hash = mixed(hash, std::bit_cast<std::uint64_t>(x + 0.0));  // -0 is 0
  return hash;
}

std::vector<int> first_equal(const Points& points) {
  FirstOf first_of(points.size());
  std::vector<int> first(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    first[i] = first_of.find_or_add(hash_of(points[i]), static_cast<int>(i),
                                    [&](int other) { return points[other] == points[i]; });
  return first;
}

/// The points kept so far in cubes of twice the distance: eight of them hold all close ones, and
/// none holds many.
class KeptPoints {
 public:
  KeptPoints(const Points& points, double distance)
      : points_(points), distance_(distance), cells_(points.size()), next_(points.size(), -1) {
    double largest = 0;  // their numbers must not overflow
    for (const Vec3& p : points) largest = std::max(largest, p.cwiseAbs().maxCoeff());
    edge_ = std::max(2 * distance, largest * 1e-300);
  }

  /// The earliest kept point close to point i; -1 where there is none.
  int close_to(int i) const {
    int first = -1;
    const Vec3 home = cell_of(points_[i]);
    const Vec3 side = side_of(points_[i], home);
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 cell = home + Vec3(corner & 1 ? side.x() : 0, corner & 2 ? side.y() : 0,
                                    corner & 4 ? side.z() : 0);
      for (int j = in_cell(cell); j >= 0; j = next_[j])
        if ((first < 0 || j < first) && (points_[j] - points_[i]).norm() < distance_) first = j;
    }
    return first;
  }

  void keep(int i) {
    const Vec3 cell = cell_of(points_[i]);
    const int head = cells_.find_or_add(hash_of(cell), i,
                                        [&](int other) { return cell_of(points_[other]) == cell; });
    if (head != i) next_[i] = std::exchange(next_[head], i);
  }

 private:
  Vec3 cell_of(const Vec3& p) const { return (p / edge_).array().floor(); }

  /// Towards the nearer neighbour along each axis: 1 or -1.
  Vec3 side_of(const Vec3& p, const Vec3& cell) const {
    const Vec3 within = p / edge_ - cell;
    return within.unaryExpr([](double x) { return x < 0.5 ? -1.0 : 1.0; });
  }

  int in_cell(const Vec3& cell) const {
    return cells_.find(hash_of(cell), [&](int other) { return cell_of(points_[other]) == cell; });
  }

  const Points& points_;
  double distance_, edge_;
  FirstOf cells_;          ///< the first kept point of each cell
  std::vector<int> next_;  ///< the others of its cell, one after the other
};

}  // namespace

std::vector<int> first_within(const Points& points, double distance) {
  std::vector<int> first = first_equal(points);
  if (!(distance > 0)) return first;
  KeptPoints kept(points, distance);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const int self = static_cast<int>(i);
    if (first[i] != self) {  // goes where its equal has gone
      first[i] = first[first[i]];
      continue;
    }
    const int close = kept.close_to(self);
    if (close >= 0)
      first[i] = close;
    else
      kept.keep(self);
  }
  return first;
}

}  // namespace sinew
