// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/physics/lists/approach_bounds.h>

#include <algorithm>
#include <cmath>

namespace sinew {

double excess_of_step(const BonePose& before, const BonePose& now, double step, double reach) {
  const Mat3 turn = now.frame.rotation * before.frame.rotation.transpose() - Mat3(Mat3::Identity());
  Mat3 spin;  // w -> the matrix of w x
  const Vec3 w = before.angular_velocity;
  spin << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
  const Vec3 shift = now.frame.origin - before.frame.origin - step * before.velocity;
  return shift.norm() + (turn - step * spin).norm() * reach;
}

template <class Real>
GroupCells::GroupCells(const BlockState<Real>& state, const Units& units,
                       std::span<const std::uint32_t> group, double reach)
    : reach_(reach) {
  Box box;
  for (std::size_t k = 0; k < state.size(); ++k) box.extend(state.position(k, units));
  size_cells(box, state.size());
  for (std::size_t k = 0; k < state.size(); ++k) {
    const Vec3 p = state.position(k, units);
    add(cell_of(p), group[k], p);
  }
}

template GroupCells::GroupCells(const BlockState<double>&, const Units&,
                                std::span<const std::uint32_t>, double);
template GroupCells::GroupCells(const BlockState<float>&, const Units&,
                                std::span<const std::uint32_t>, double);

void GroupCells::size_cells(const Box& box, std::size_t particles) {
  edge_ = reach_ * (1 + 1e-5);  // rounding must not put neighbors two cells apart
  if (!box.isEmpty()) {
    low_ = box.min();
    const Vec3 size = box.sizes();
    const auto along = [&](int axis) { return std::floor(size[axis] / edge_) + 1; };
    // A particle far away must not make the table huge: larger cells are correct, only slower.
    const double most = static_cast<double>(particles) + 4096;
    while (along(0) * along(1) * along(2) > most) edge_ *= 1.5;
    for (int axis = 0; axis < 3; ++axis) counts_[axis] = static_cast<std::int64_t>(along(axis));
  }
  first_.assign(static_cast<std::size_t>(counts_[0] * counts_[1] * counts_[2]), -1);
}

std::size_t GroupCells::cell_of(const Vec3& p) const {
  std::array<std::int64_t, 3> at;
  for (int axis = 0; axis < 3; ++axis)
    at[axis] = std::clamp<std::int64_t>(static_cast<std::int64_t>((p[axis] - low_[axis]) / edge_),
                                        0, counts_[axis] - 1);
  return static_cast<std::size_t>((at[2] * counts_[1] + at[1]) * counts_[0] + at[0]);
}

void GroupCells::add(std::size_t cell, std::uint32_t group, const Vec3& p) {
  std::int64_t part = first_[cell];
  while (part >= 0 && parts_[part].group != group) part = parts_[part].next;
  if (part < 0) {
    part = static_cast<std::int64_t>(parts_.size());
    parts_.push_back({group, first_[cell], {}});
    first_[cell] = part;
  }
  parts_[part].box.extend(p);
}

void GroupCells::meet(const Part& one, const Part& other, std::map<Pair, Meeting>& met) const {
  if (one.group == other.group) return;
  const double gap = one.box.exteriorDistance(other.box);
  if (gap >= reach_) return;
  const bool ordered = one.group < other.group;
  const Part &a = ordered ? one : other, &b = ordered ? other : one;
  Meeting& meeting = met.try_emplace({a.group, b.group}, Meeting{{}, {}, gap}).first->second;
  meeting.near_a.extend(a.box);
  meeting.near_b.extend(b.box);
  meeting.gap = std::min(meeting.gap, gap);
}

/// The parts of a cell with each other, and with those of the later half of the cells around it.
void GroupCells::meet_around(std::size_t cell, std::map<Pair, Meeting>& met) const {
  const auto c = static_cast<std::int64_t>(cell);
  const std::array<std::int64_t, 3> at{c % counts_[0], c / counts_[0] % counts_[1],
                                       c / (counts_[0] * counts_[1])};
  for (int n = 13; n < 27; ++n) {  // the later half of the 27 cells
    const std::int64_t i = at[0] + n % 3 - 1, j = at[1] + n / 3 % 3 - 1, k = at[2] + n / 9 - 1;
    if (i < 0 || i >= counts_[0] || j < 0 || j >= counts_[1] || k >= counts_[2]) continue;
    const std::int64_t other = (k * counts_[1] + j) * counts_[0] + i;
    for (std::int64_t one = first_[cell]; one >= 0; one = parts_[one].next)
      for (std::int64_t two = other == c ? parts_[one].next : first_[other]; two >= 0;
           two = parts_[two].next)
        meet(parts_[one], parts_[two], met);
  }
}

std::map<GroupCells::Pair, GroupCells::Meeting> GroupCells::meetings() const {
  std::map<Pair, Meeting> met;
  for (std::size_t cell = 0; cell < first_.size(); ++cell)
    if (first_[cell] >= 0) meet_around(cell, met);
  return met;
}

namespace {

constexpr double ranges_of_reach = 2;
constexpr std::size_t most_slices = 8;

Box expanded(Box box, double by) {
  box.min().array() -= by;
  box.max().array() += by;
  return box;
}

/// The largest |(A - B) x| over a box: convex, so at a corner.
double largest_difference(const RigidMotion& a, const RigidMotion& b, const Box& box) {
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

/// An upper bound of the same, cheaper.
double rough_difference(const RigidMotion& a, const RigidMotion& b, const Box& box) {
  if (box.isEmpty()) return 0;
  const Mat3 turn = a.turn - b.turn;
  return (turn * box.center() + a.shift - b.shift).norm() + turn.norm() * box.diagonal().norm() / 2;
}

/// How much nearer a point of one box and one of the other may have come, if more than `most`.
double approach_of(const RigidMotion& a, const RigidMotion& b, const Box& box_a, const Box& box_b,
                   double spare, double most) {
  if (std::min(rough_difference(a, b, box_a), rough_difference(a, b, box_b)) - spare <= most)
    return most;
  return std::max(
      most, std::min(largest_difference(a, b, box_a), largest_difference(a, b, box_b)) - spare);
}

/// The motion of b seen from a.
RigidMotion seen_from(const RigidMotion& a, const RigidMotion& b) {
  return {a.turn.transpose() * b.turn, a.turn.transpose() * (b.shift - a.shift)};
}

/// Bounding boxes of slices across the longest side.
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
Contacts::Contacts(const BlockState<Real>& state, const Units& units,
                   std::span<const std::uint32_t> comoving_frame, std::size_t groups, double range)
    : range_(range),
      reach_(ranges_of_reach * range),
      whole_(groups),
      radius_(groups),
      slices_(groups) {
  const GroupCells cells(state, units, comoving_frame, reach_);
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

template Contacts::Contacts(const BlockState<double>&, const Units&, std::span<const std::uint32_t>,
                            std::size_t, double);
template Contacts::Contacts(const BlockState<float>&, const Units&, std::span<const std::uint32_t>,
                            std::size_t, double);

double Contacts::approach_near(const Pair& pair, std::span<const RigidMotion> motions, double shift,
                               double most) const {
  if (pair.near_a.isEmpty()) return most;
  const double spare = std::max(0.0, pair.gap - range_ - 2 * shift);
  return approach_of(motions[pair.a], motions[pair.b], expanded(pair.near_a, shift),
                     expanded(pair.near_b, shift), spare, most);
}

double Contacts::approach_far(const Pair& pair, std::span<const RigidMotion> motions, double shift,
                              double most) const {
  const RigidMotion &a = motions[pair.a], &b = motions[pair.b];
  const double least = std::max(reach_, pair.gap) - range_ - 2 * shift;
  if (approach_of(a, b, expanded(whole_[pair.a], shift), expanded(whole_[pair.b], shift), least,
                  most) <= most)
    return most;
  for (const Box& in_a : slices_[pair.a])
    for (const Box& in_b : slices_[pair.b]) {
      const double spare = std::max(least, in_a.exteriorDistance(in_b) - range_ - 2 * shift);
      most = approach_of(a, b, expanded(in_a, shift), expanded(in_b, shift), spare, most);
    }
  return most;
}

/// Whether spheres around two groups are so far apart that the lists need none of their pairs.
bool Contacts::apart(const Pair& pair, std::span<const Vec3> centers, double shift) const {
  const double least = radius_[pair.a] + radius_[pair.b] + range_ + 2 * shift;
  return (centers[pair.a] - centers[pair.b]).squaredNorm() >= least * least;
}

double Contacts::approach(std::span<const RigidMotion> motions, double shift) const {
  std::vector<Vec3> centers(whole_.size());
  for (std::size_t group = 0; group < whole_.size(); ++group)
    centers[group] = motions[group].turn * whole_[group].center() + motions[group].shift;
  double most = 0;
  for (const Pair& pair : pairs_) {
    if (apart(pair, centers, shift)) continue;
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
      return largest_difference(now, then, near_b) + turned;
    };
    const double in_a = added(pair.a, pair.b, expanded(pair.near_b, shift));
    if (in_a > most)
      most = std::max(most, std::min(in_a, added(pair.b, pair.a, expanded(pair.near_a, shift))));
  }
  return most;
}

double Contacts::reach_from(const Vec3& point, std::size_t group) const {
  if (whole_[group].isEmpty()) return 0;
  return (point - whole_[group].center()).norm() + radius_[group];
}

}  // namespace sinew
