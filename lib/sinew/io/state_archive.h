// SPDX-License-Identifier: GPL-3.0-or-later
// Saved states of simulations as bytes, for core/archive.h: members in the order of a checkpoint,
// which leaves out what states have in memory alone.
//
//     const std::string bytes = archived(simulation.save());
//     simulation.restore(unarchived<SimulationState>(bytes));
#pragma once

#include <sinew/core/archive.h>
#include <sinew/core/simulation_state.h>

namespace sinew {

template <class Archive, class Coord, class Real>
void serialize(Archive& archive, MovingColumns<Coord, Real>& moving) {
  for (auto& axis : moving.x) archive(axis);
  for (auto& axis : moving.v) archive(axis);
}

template <class Archive>
void serialize(Archive& archive, StateColumn& column) {
  archive(column.name);
  archive(column.numbers);
}

template <class Archive>
void serialize(Archive& archive, StatePart& part) {
  archive(part.name);
  archive(part.columns);
}

template <class Archive>
void serialize(Archive& archive, SimulationState& state) {
  archive(state.steps);
  archive(state.kicked);
  archive(state.fixed_point_units.length);
  archive(state.fixed_point_units.origin);
  archive(state.fixed_point_units.box.min());
  archive(state.fixed_point_units.box.max());
  archive(state.fixed_point_units.traveled);
  archive(state.order);
  archive(state.moving);
  archive(state.parts);
}

}  // namespace sinew
