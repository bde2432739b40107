// SPDX-License-Identifier: GPL-3.0-or-later
// What a body is damped relative to, at each moment: the motions of what holds it, and of parts
// that move by themselves those that a rigid body would have with their momentum, angular momentum
// and inertia at present, so that forces relative to these sum to zero, and so do their moments.
// Sums are in double precision and over fixed blocks: the same bits on all threads.
//
//     RigidReferences references(body);
//     references.set_order(id);
//     references.find(moment, state, units);
//     references.damping()->velocity_at(id, p, references.motions());
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <sinew/body/body.h>
#include <sinew/kernel/kernel.h>
#include <sinew/lists/block_state.h>
#include <sinew/stepping/stepper.h>

namespace sinew {

class RigidReferences {
 public:
  explicit RigidReferences(std::shared_ptr<const Body> body);

  /// None: the body has no such damping.
  const RigidDamping* damping() const { return damping_.get(); }
  /// The particles `id` in the order of the states.
  void set_order(std::span<const std::int32_t> id);
  /// Before a step after so many: whether bonds have broken since the last look that was due, after
  /// which what holds the pieces, and slots of the kernel, are others.
  bool follow_cracks(std::int64_t steps, const Stepper& stepper);

  template <class Real>
  void find(const TimedPose& moment, const kernel::State<Real>& state, const Units& units);
  /// One for each reference.
  std::span<const AffineMotion> motions() const { return motions_; }
  /// Force of the damping on a particle, N.
  Vec3 force(std::size_t id, double mass, const Vec3& position, const Vec3& velocity) const {
    return -damping_->rate * mass * (velocity - damping_->velocity_at(id, position, motions_));
  }

  void save(SimulationState& state) const;
  /// Before set_order().
  void restore(const SimulationState& state);

 private:
  struct Part {
    std::uint32_t reference;
    std::size_t first;              ///< first of its particles, about which sums are
    std::vector<std::size_t> pins;  ///< its particles that pins and supports hold
  };
  using Sums = std::array<double, kernel::momenta>;
  struct Run {
    std::uint32_t part;
    Sums sums;
  };

  void set_damping(std::shared_ptr<const RigidDamping> damping);
  template <class Real>
  Sums sums_of(const kernel::State<Real>& state, const Units& units, const Vec3& about,
               std::size_t begin, std::size_t end) const;
  AffineMotion motion_of(const Part& part, const Sums& sums, const Vec3& about,
                         std::span<const Vec3> pins) const;

  static constexpr std::uint32_t none = UINT32_MAX;
  std::shared_ptr<const Body> body_;
  std::shared_ptr<const RigidDamping> damping_;
  kernel::InstructionSet instructions_ = kernel::best_instruction_set();
  bool alone_ = false;  ///< nothing holds any particle
  std::vector<Part> parts_;
  std::vector<std::int32_t> id_;
  std::vector<double> mass_;          ///< in the order; empty: all alike
  std::vector<std::uint32_t> part_;   ///< part of each particle, in the order; empty: of none
  SharedNeighbors near_;              ///< at rest, once bonds have broken
  std::vector<std::uint32_t> piece_;  ///< label by id, once bonds have broken
  std::int64_t broken_ = 0;           ///< ends of bonds, when these were found
  std::vector<AffineMotion> motions_;
};

}  // namespace sinew
