// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/lists/contacts.h"

#include <algorithm>
#include <cmath>

#include "physics/lists/group_cells.h"

namespace sinew {
namespace {

constexpr double ranges_of_reach = 2;
constexpr std::size_t most_slices = 8;

Box wider(Box box, double by) {
  box.min().array() -= by;
  box.max().array() += by;
  return box;
}

/// The largest |(A - B) x| over a box: convex, so at a corner.
double difference_within(const RigidMotion& a, const RigidMotion& b, const Box& box) {
  if (box.isEmpty()) return 0;
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
double rough_difference(const RigidMotion& a, const RigidMotion& b, const Box& box) {
  if (box.isEmpty()) return 0;
  const Mat3 turn = a.turn - b.turn;
  return (turn * box.center() + a.shift - b.shift).norm() + turn.norm() * box.diagonal().norm() / 2;
}

/// How far a point of one box and one of the other may have come nearer. What does not exceed
/// `most` is not looked at closely.
double approach_of(const RigidMotion& a, const RigidMotion& b, const Box& box_a, const Box& box_b,
                   double spare, double most) {
  if (std::min(rough_difference(a, b, box_a), rough_difference(a, b, box_b)) - spare <= most)
    return most;
  return std::max(most,
                  std::min(difference_within(a, b, box_a), difference_within(a, b, box_b)) - spare);
}

/// The motion of b in the directions and from the place of a.
RigidMotion seen_from(const RigidMotion& a, const RigidMotion& b) {
  return {a.turn.transpose() * b.turn, a.turn.transpose() * (b.shift - a.shift)};
}

/// Boxes of slices across the longest side.
std::vector<Box> sliced(const Box& whole, std::span<const Box> parts) {
  int axis = 0;
  const double length = whole.sizes().maxCoeff(&axis);
  std::vector<Box> slices(std::min(most_slices, parts.size()));
  for (const Box& part : parts) {
    const double at = length > 0 ? (part.center()[axis] - whole.min()[axis]) / length : 0;
    const auto count = static_cast<double>(slices.size());
    slices[static_cast<std::size_t>(std::clamp(at * count, 0.0, count - 1))].extend(part);
  }
  std::erase_if(slices, [](const Box& slice) { return slice.isEmpty(); });
  return slices;
}

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

template <class Real>
Contacts::Contacts(const BlockState<Real>& state, const Measure& measure,
                   std::span<const std::uint32_t> carrier, std::size_t groups, double range)
    : range_(range),
      reach_(ranges_of_reach * range),
      whole_(groups),
      radius_(groups),
      slices_(groups) {
  const GroupCells cells(state, measure, carrier, reach_);
  std::vector<std::vector<Box>> parts(groups);
  for (const GroupCells::Part& part : cells.parts()) {
    whole_[part.group].extend(part.box);
    parts[part.group].push_back(part.box);
  }
  for (std::size_t group = 0; group < groups; ++group) {
    slices_[group] = sliced(whole_[group], parts[group]);
    radius_[group] = whole_[group].isEmpty() ? 0 : whole_[group].diagonal().norm() / 2;
  }
  const auto met = cells.meetings();
  for (std::size_t a = 0; a < groups; ++a)
    for (std::size_t b = a + 1; b < groups; ++b) {
      if (whole_[a].isEmpty() || whole_[b].isEmpty()) continue;
      const auto found = met.find({a, b});
      if (found == met.end())
        pairs_.push_back({a, b, {}, {}, std::max(reach_, whole_[a].exteriorDistance(whole_[b]))});
      else
        pairs_.push_back({a, b, found->second.near_a, found->second.near_b, found->second.gap});
    }
}

template Contacts::Contacts(const BlockState<double>&, const Measure&,
                            std::span<const std::uint32_t>, std::size_t, double);
template Contacts::Contacts(const BlockState<float>&, const Measure&,
                            std::span<const std::uint32_t>, std::size_t, double);

double Contacts::approach_near(const Pair& pair, std::span<const RigidMotion> motions, double shift,
                               double most) const {
  if (pair.near_a.isEmpty()) return most;
  const double spare = std::max(0.0, pair.gap - range_ - 2 * shift);
  return approach_of(motions[pair.a], motions[pair.b], wider(pair.near_a, shift),
                     wider(pair.near_b, shift), spare, most);
}

double Contacts::approach_far(const Pair& pair, std::span<const RigidMotion> motions, double shift,
                              double most) const {
  const RigidMotion &a = motions[pair.a], &b = motions[pair.b];
  const double least = std::max(reach_, pair.gap) - range_ - 2 * shift;
  if (approach_of(a, b, wider(whole_[pair.a], shift), wider(whole_[pair.b], shift), least, most) <=
      most)
    return most;
  for (const Box& in_a : slices_[pair.a])
    for (const Box& in_b : slices_[pair.b]) {
      const double spare = std::max(least, in_a.exteriorDistance(in_b) - range_ - 2 * shift);
      most = approach_of(a, b, wider(in_a, shift), wider(in_b, shift), spare, most);
    }
  return most;
}

/// Whether spheres around two groups are now so far apart that the lists need none of their pairs.
bool Contacts::apart(const Pair& pair, std::span<const Vec3> centres, double shift) const {
  const double least = radius_[pair.a] + radius_[pair.b] + range_ + 2 * shift;
  return (centres[pair.a] - centres[pair.b]).squaredNorm() >= least * least;
}

double Contacts::approach(std::span<const RigidMotion> motions, double shift) const {
  std::vector<Vec3> centres(whole_.size());
  for (std::size_t group = 0; group < whole_.size(); ++group)
    centres[group] = motions[group].turn * whole_[group].center() + motions[group].shift;
  double most = 0;
  for (const Pair& pair : pairs_) {
    if (apart(pair, centres, shift)) continue;
    most = approach_near(pair, motions, shift, most);
    most = approach_far(pair, motions, shift, most);
  }
  return most;
}

double Contacts::approach_since(std::span<const RigidMotion> earlier,
                                std::span<const RigidMotion> motions, double moved,
                                double shift) const {
  double most = 0;
  for (const Pair& pair : pairs_) {
    if (pair.gap - 2 * shift >= range_) continue;
    const auto added = [&](std::size_t a, std::size_t b, const Box& near_b) {
      const RigidMotion then = seen_from(earlier[a], earlier[b]);
      const RigidMotion now = seen_from(motions[a], motions[b]);
      const double turned = (now.turn - then.turn).norm() * moved;
      if (rough_difference(now, then, near_b) + turned <= most) return most;
      return difference_within(now, then, near_b) + turned;
    };
    const double in_a = added(pair.a, pair.b, wider(pair.near_b, shift));
    if (in_a > most)
      most = std::max(most, std::min(in_a, added(pair.b, pair.a, wider(pair.near_a, shift))));
  }
  return most;
}

double Contacts::reach_from(const Vec3& point, std::size_t group) const {
  if (whole_[group].isEmpty()) return 0;
  return (point - whole_[group].center()).norm() + radius_[group];
}

}  // namespace sinew
