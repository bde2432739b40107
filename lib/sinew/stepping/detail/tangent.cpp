// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/stepping/detail/tangent.h>

#include <algorithm>

#include <sinew/material/laws.h>
#include <sinew/world/world.h>

namespace sinew {
namespace {

// Steps of differences, in radii: rounding leaves 1e-8 of the stiffness, curvature 1e-6 of it.
constexpr double step_in_radii = 1e-6;

/// Whom each particle's place reaches, itself included, ascending: those bonded to it, and where
/// volume is kept, the neighbors of its nearest neighbors.
NeighborLists reached_at_rest(const RestNeighbors& near, bool keeps_volume) {
  NeighborLists reached;
  reached.first.push_back(0);
  for (std::size_t i = 0; i < near.all().size(); ++i) {
    const auto begin = static_cast<std::ptrdiff_t>(reached.neighbor.size());
    const auto add = [&](std::span<const std::uint32_t> more) {
      reached.neighbor.insert(reached.neighbor.end(), more.begin(), more.end());
    };
    reached.neighbor.push_back(static_cast<std::uint32_t>(i));
    add(near.all().of(i));
    if (keeps_volume)
      for (const std::uint32_t j : near.nearest.of(i)) add(near.nearest.of(j));
    std::sort(reached.neighbor.begin() + begin, reached.neighbor.end());
    reached.neighbor.erase(std::unique(reached.neighbor.begin() + begin, reached.neighbor.end()),
                           reached.neighbor.end());
    reached.first.push_back(static_cast<std::uint32_t>(reached.neighbor.size()));
  }
  return reached;
}

/// The same lists of particles that are in the order of `id`.
NeighborLists in_order(const NeighborLists& by_id, std::span<const std::int32_t> id) {
  std::vector<std::uint32_t> place(id.size());
  for (std::uint32_t k = 0; k < id.size(); ++k) place[static_cast<std::size_t>(id[k])] = k;
  NeighborLists lists;
  lists.first.push_back(0);
  for (const std::int32_t one : id) {
    for (const std::uint32_t j : by_id.of(static_cast<std::size_t>(one)))
      lists.neighbor.push_back(place[j]);
    lists.first.push_back(static_cast<std::uint32_t>(lists.neighbor.size()));
  }
  return lists;
}

}  // namespace

Tangent::Tangent(const Body& body, const RestNeighbors& near, std::span<const std::int32_t> id)
    : step_(step_in_radii * body.material.pair.r),
      reached_(in_order(reached_at_rest(near, keeps_volume(body)), id)),
      unknown_(id.size()) {
  std::vector<std::array<bool, 3>> held(id.size());
  if (body.world)
    for (const Pinned& pin : body.world->pins)
      for (int axis = 0; axis < 3; ++axis)
        held[pin.particle][static_cast<std::size_t>(axis)] = pin.holds(axis);
  for (std::size_t i = 0; i < id.size(); ++i) {
    const auto own = static_cast<std::size_t>(id[i]);
    mass_.push_back(mass_of(body, own, body.material.mass));
    for (std::size_t axis = 0; axis < 3; ++axis)
      unknown_[i][axis] = held[own][axis] ? -1 : static_cast<std::int32_t>(unknowns_++);
  }
  find_colors();
}

/// Particles of a color reach nobody in common.
void Tangent::find_colors() {
  const std::size_t count = unknown_.size();
  std::vector<std::int32_t> color(count, -1);
  std::vector<std::size_t> taken;  // one per color: the last particle that met it
  for (std::size_t i = 0; i < count; ++i) {
    for (const std::uint32_t j : reached_.of(i))
      for (const std::uint32_t k : reached_.of(j))
        if (color[k] >= 0) taken[static_cast<std::size_t>(color[k])] = i + 1;
    const auto free =
        std::find_if(taken.begin(), taken.end(), [&](std::size_t by) { return by != i + 1; });
    color[i] = static_cast<std::int32_t>(free - taken.begin());
    if (free == taken.end()) {
      taken.push_back(0);
      of_color_.emplace_back();
    }
    of_color_[static_cast<std::size_t>(color[i])].push_back(static_cast<std::uint32_t>(i));
  }
}

Tangent::Matrix Tangent::pattern() const {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t j = 0; j < unknown_.size(); ++j)
    for (const std::uint32_t i : reached_.of(j))
      for (const std::int32_t row : unknown_[i])
        for (const std::int32_t column : unknown_[j])
          if (row >= 0 && column >= 0) entries.emplace_back(row, column, 1);
  Matrix matrix(unknowns_, unknowns_);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

Tangent::Matrix Tangent::at(Stepper& stepper, const TimedPose& now, const Points& positions) const {
  Forces before, after;
  stepper.evaluate(now, before);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(9 * reached_.neighbor.size());
  const auto take = [&](std::uint32_t j, std::size_t axis) {
    const std::int32_t column = unknown_[j][axis];
    if (column < 0) return;
    for (const std::uint32_t i : reached_.of(j)) {
      const Vec3 stiffness = (before.total(i) - after.total(i)) / step_;
      for (std::size_t along = 0; along < 3; ++along)
        if (unknown_[i][along] >= 0)
          entries.emplace_back(unknown_[i][along], column,
                               stiffness[static_cast<Eigen::Index>(along)]);
    }
  };
  for (const std::vector<std::uint32_t>& particles : of_color_)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Points beside = positions;
      for (const std::uint32_t j : particles) beside[j][static_cast<Eigen::Index>(axis)] += step_;
      stepper.place(beside, Stepper::Move::slight);
      stepper.evaluate(now, after);
      for (const std::uint32_t j : particles) take(j, axis);
    }
  stepper.place(positions, Stepper::Move::slight);
  Matrix matrix(unknowns_, unknowns_);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return (matrix + Matrix(matrix.transpose())) / 2;
}

Tangent::Vector Tangent::forces(Stepper& stepper, const TimedPose& now, const Vec3& gravity) const {
  Forces all;
  stepper.evaluate(now, all);
  Vector free(unknowns_);
  for (std::size_t i = 0; i < unknown_.size(); ++i) {
    const Vec3 force = all.total(i) + mass_[i] * gravity;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (unknown_[i][axis] >= 0) free[unknown_[i][axis]] = force[static_cast<Eigen::Index>(axis)];
  }
  return free;
}

Points Tangent::moved(Points positions, const Vector& by) const {
  for (std::size_t i = 0; i < unknown_.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (unknown_[i][axis] >= 0)
        positions[i][static_cast<Eigen::Index>(axis)] += by[unknown_[i][axis]];
  return positions;
}

double Tangent::largest_gradient(const Points& positions, const Vector& by) const {
  const Points after = moved(positions, by);
  double largest = 0;
  for (std::size_t i = 0; i < positions.size(); ++i)
    for (const std::uint32_t j : reached_.of(i)) {
      const Vec3 apart = positions[j] - positions[i];
      if (i != j) largest = std::max(largest, (after[j] - after[i] - apart).norm() / apart.norm());
    }
  return largest;
}

}  // namespace sinew
