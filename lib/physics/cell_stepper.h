// SPDX-License-Identifier: GPL-3.0-or-later
// Steps as the paper describes them, with its cells sorted anew in every step: the readable
// reference, and the way for what the kernel does not know.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "physics/solid/solid.h"
#include "physics/stepper.h"
#include "rig/pose.h"

namespace sinew {

class CellStepper {
 public:
  CellStepper(std::shared_ptr<const Body> body, const Stepping& stepping, Particles particles);

  StepSums step(const Pose& pose);
  Balance evaluate(const Pose& pose, Forces& forces);
  void read(const Pose& pose, Particles& particles);
  /// Bonds broken so far, by particle; none for a body without bonds.
  std::span<const std::int32_t> broken_bonds() const;

  void save(SimulationState& state) const;
  void restore(const SimulationState& state);

 private:
  void find_forces(const Pose& pose);
  double stored_in_pairs();
  Vec3 acceleration(std::size_t i) const;
  StepSums sums() const;
  void advance(std::size_t i, double kick);
  bool sound(std::size_t i, const Vec3& before, const Pose& pose) const;

  std::shared_ptr<const Body> body_;
  Stepping stepping_;
  Particles particles_;
  std::optional<Solid> solid_;  ///< of materials that remember who was whose neighbour
  Forces forces_;
  bool kicked_ = false;  ///< velocities are half a step ahead (velocity Verlet)
};

}  // namespace sinew
