// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/lists/bone_contacts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace sinew {
namespace {

constexpr std::int64_t rings = 2;  // of cells around a group's own that count as near it

/// The largest |(A - B) x| over a box: convex, so at a corner.
double difference_within(const RigidMotion& a, const RigidMotion& b, Box box, double wider = 0) {
  if (box.isEmpty()) return 0;
  box.min().array() -= wider;
  box.max().array() += wider;
  const Mat3 turn = a.turn - b.turn;
  const Vec3 shift = a.shift - b.shift;
  double most = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 x = box.corner(static_cast<Box::CornerType>(corner));
    most = std::max(most, (turn * x + shift).squaredNorm());
  }
  return std::sqrt(most);
}

/// Cheaply, no less than that.
double rough_difference(const RigidMotion& a, const RigidMotion& b, const Box& box, double wider) {
  const Mat3 turn = a.turn - b.turn;
  const double half = box.diagonal().norm() / 2 + 2 * wider;
  return (turn * box.center() + a.shift - b.shift).norm() + turn.norm() * half;
}

/// The motion of b in the directions and from the place of a.
RigidMotion seen_from(const RigidMotion& a, const RigidMotion& b) {
  return {a.turn.transpose() * b.turn, a.turn.transpose() * (b.shift - a.shift)};
}

/// The groups with particles in each cell, and the box of the cell.
class CellGroups {
 public:
  CellGroups(const BlockCells& cells, std::span<const std::uint32_t> lead)
      : sole_(cells.cells(), nobody) {
    const auto cell = cells.cell_of_particle();
    for (std::size_t k = 0; k < cell.size(); ++k) add(cell[k], lead[k]);
  }

  template <class Visit>
  void for_each_group(std::size_t cell, Visit&& visit) const {
    if (sole_[cell] == nobody) return;
    if (sole_[cell] != several) return visit(sole_[cell]);
    for (const std::uint32_t group : many_.at(cell)) visit(group);
  }

  bool empty(std::size_t cell) const { return sole_[cell] == nobody; }
  /// Whether `other` holds no group but the one of `cell`.
  bool alone_with(std::size_t cell, std::size_t other) const {
    return sole_[other] == nobody || (sole_[other] == sole_[cell] && sole_[cell] != several);
  }

 private:
  static constexpr std::uint32_t nobody = 0xffffffff, several = 0xfffffffe;

  void add(std::uint32_t cell, std::uint32_t group) {
    if (sole_[cell] == nobody) sole_[cell] = group;
    if (sole_[cell] == group) return;
    auto& groups = many_[cell];
    if (sole_[cell] != several) groups.push_back(sole_[cell]), sole_[cell] = several;
    if (std::find(groups.begin(), groups.end(), group) == groups.end()) groups.push_back(group);
  }

  std::vector<std::uint32_t> sole_;
  std::map<std::size_t, std::vector<std::uint32_t>> many_;
};

/// Where cells lie in the scene.
struct CellBoxes {
  const BlockCells& cells;
  Vec3 origin;
  double scale;

  std::array<std::int64_t, 3> index(std::size_t cell) const {
    const auto& n = cells.counts();
    const auto c = static_cast<std::int64_t>(cell);
    return {c % n[0], c / n[0] % n[1], c / (n[0] * n[1])};
  }
  Box box(std::size_t cell) const {
    const auto [i, j, k] = index(cell);
    const Vec3 step(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
    const Vec3 low = cells.low() + cells.edge() * step;
    const Vec3 corner = low + Vec3::Constant(cells.edge());
    return {origin + scale * low, origin + scale * corner};
  }
  template <class Visit>
  void for_each_around(std::size_t cell, Visit&& visit) const {
    const auto& n = cells.counts();
    const auto at = index(cell);
    std::array<std::int64_t, 3> from, to;
    for (int axis = 0; axis < 3; ++axis) {
      from[axis] = std::max<std::int64_t>(at[axis] - rings, 0);
      to[axis] = std::min(at[axis] + rings, n[axis] - 1);
    }
    for (std::int64_t k = from[2]; k <= to[2]; ++k)
      for (std::int64_t j = from[1]; j <= to[1]; ++j)
        for (std::int64_t i = from[0]; i <= to[0]; ++i)
          visit(static_cast<std::size_t>((k * n[1] + j) * n[0] + i));
  }
};

}  // namespace

std::vector<RigidMotion> motions_between(const Pose& before, const Pose& now) {
  std::vector<RigidMotion> motions(before.size() + 1);
  for (std::size_t b = 0; b < before.size(); ++b) {
    RigidMotion& motion = motions[b];
    motion.turn = now[b].frame.rotation * before[b].frame.rotation.transpose();
    motion.shift = now[b].frame.origin - motion.turn * before[b].frame.origin;
  }
  return motions;
}

BoneContacts::BoneContacts(const BlockCells& cells, std::span<const std::uint32_t> lead,
                           std::size_t groups, const Vec3& origin, double scale, double range)
    : range_(range), reach_(static_cast<double>(rings) * cells.edge() * scale), whole_(groups) {
  find_pairs(cells, lead, origin, scale);
}

void BoneContacts::find_pairs(const BlockCells& cells, std::span<const std::uint32_t> lead,
                              const Vec3& origin, double scale) {
  const CellGroups in(cells, lead);
  const CellBoxes boxes{cells, origin, scale};
  std::map<std::pair<std::size_t, std::size_t>, Box>
      near;  // particles of the first near the second
  for (std::size_t cell = 0; cell < cells.cells(); ++cell) {
    if (in.empty(cell)) continue;
    const Box box = boxes.box(cell);
    in.for_each_group(cell, [&](std::size_t group) { whole_[group].extend(box); });
    if (whole_.size() == 1) continue;
    boxes.for_each_around(cell, [&](std::size_t other) {
      if (in.alone_with(cell, other)) return;
      in.for_each_group(cell, [&](std::size_t mine) {
        in.for_each_group(other, [&](std::size_t theirs) {
          if (mine != theirs) near[{mine, theirs}].extend(box);
        });
      });
    });
  }
  for (std::size_t a = 0; a < whole_.size(); ++a)
    for (std::size_t b = a + 1; b < whole_.size(); ++b) {
      if (whole_[a].isEmpty() || whole_[b].isEmpty()) continue;
      const auto met = near.find({a, b});
      if (met != near.end())
        pairs_.push_back({a, b, met->second, near.at({b, a})});
      else
        apart_.push_back({a, b, std::max(reach_, whole_[a].exteriorDistance(whole_[b]))});
    }
}

double BoneContacts::approach(std::span<const RigidMotion> motions, double shift) const {
  double most = 0;
  for (const Pair& pair : pairs_) {
    const RigidMotion &a = motions[pair.a], &b = motions[pair.b];
    most = std::max(most, std::min(difference_within(a, b, pair.near_a, shift),
                                   difference_within(a, b, pair.near_b, shift)));
    // Pairs beyond the reach have that much farther to go.
    most = std::max(most, std::min(difference_within(a, b, whole_[pair.a], shift),
                                   difference_within(a, b, whole_[pair.b], shift)) -
                              (reach_ - range_ - 2 * shift));
  }
  for (const Apart& pair : apart_) {
    const RigidMotion &a = motions[pair.a], &b = motions[pair.b];
    const double spare = pair.gap - range_ - 2 * shift;
    if (rough_difference(a, b, whole_[pair.a], shift) - spare <= most) continue;
    most = std::max(most, std::min(difference_within(a, b, whole_[pair.a], shift),
                                   difference_within(a, b, whole_[pair.b], shift)) -
                              spare);
  }
  return most;
}

double BoneContacts::approach_since(std::span<const RigidMotion> earlier,
                                    std::span<const RigidMotion> motions, double moved,
                                    double shift) const {
  double most = 0;
  for (const Pair& pair : pairs_) {
    const auto added = [&](std::size_t a, std::size_t b, const Box& near_b) {
      const RigidMotion then = seen_from(earlier[a], earlier[b]);
      const RigidMotion now = seen_from(motions[a], motions[b]);
      return difference_within(now, then, near_b, shift) + (now.turn - then.turn).norm() * moved;
    };
    most = std::max(
        most, std::min(added(pair.a, pair.b, pair.near_b), added(pair.b, pair.a, pair.near_a)));
  }
  return most;
}

double BoneContacts::reach_from(const Vec3& point, std::size_t group) const {
  if (whole_[group].isEmpty()) return 0;
  return (point - whole_[group].center()).norm() + whole_[group].diagonal().norm() / 2;
}

double BoneContacts::travel(std::span<const RigidMotion> motions) const {
  double most = 0;
  for (std::size_t group = 0; group < whole_.size(); ++group)
    most = std::max(most, difference_within(motions[group], RigidMotion(), whole_[group]));
  return most;
}

}  // namespace sinew
