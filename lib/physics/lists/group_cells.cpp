// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/lists/group_cells.h"

#include <algorithm>
#include <cmath>

namespace sinew {

template <class Real>
GroupCells::GroupCells(const BlockState<Real>& state, const Measure& measure,
                       std::span<const std::uint32_t> group, double reach)
    : reach_(reach) {
  Box box;
  for (std::size_t k = 0; k < state.size(); ++k) box.extend(state.position(k, measure));
  size_cells(box, state.size());
  for (std::size_t k = 0; k < state.size(); ++k) {
    const Vec3 p = state.position(k, measure);
    add(cell_of(p), group[k], p);
  }
}

template GroupCells::GroupCells(const BlockState<double>&, const Measure&,
                                std::span<const std::uint32_t>, double);
template GroupCells::GroupCells(const BlockState<float>&, const Measure&,
                                std::span<const std::uint32_t>, double);

void GroupCells::size_cells(const Box& box, std::size_t particles) {
  edge_ = reach_ * (1 + 1e-5);  // rounding must not put partners two cells apart
  if (!box.isEmpty()) {
    low_ = box.min();
    const Vec3 size = box.sizes();
    const auto along = [&](int axis) { return std::floor(size[axis] / edge_) + 1; };
    // A stray particle must not blow the table up: wider cells stay correct, only slower.
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

/// The parts of a cell with each other, and with those of the cells around that come after it.
void GroupCells::meet_around(std::size_t cell, std::map<Pair, Meeting>& met) const {
  const auto c = static_cast<std::int64_t>(cell);
  const std::array<std::int64_t, 3> at{c % counts_[0], c / counts_[0] % counts_[1],
                                       c / (counts_[0] * counts_[1])};
  for (int n = 13; n < 27; ++n) {  // of the 27 cells around, the later half
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

}  // namespace sinew
