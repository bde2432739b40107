// SPDX-License-Identifier: GPL-3.0-or-later
// The lists of partners of a moving body, kept true: at every step they hold all pairs within b.
//
// A outer list, found with the cells, lasts long; a narrow one, pruned from it, is what the kernel
// works through. Both hold until particles have approached by their skins, judged by what the
// co-moving frames' motions and the fastest particle allow, step by step, and by a look at all
// particles when that is used up. A look that finds a few particles escaped, as in a body that
// flows, gives those alone new partners; when there are many, all lists are made anew.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include <sinew/physics/kernel/kernel.h>
#include <sinew/physics/lists/approach_bounds.h>
#include <sinew/physics/lists/block_cells.h>
#include <sinew/physics/lists/block_state.h>
#include <sinew/physics/lists/offset_lists.h>
#include <sinew/physics/pair_force.h>
#include <sinew/physics/stepper.h>
#include <sinew/rig/pose.h>

namespace sinew {

/// Particles, and the frames that carry them, at one moment.
template <class Real>
struct MovingParticles {
  BlockState<Real>& state;
  const Units& units;
  kernel::ComovingFrames<Real> comoving_frames;
  std::span<const std::uint32_t> comoving_frame;  ///< by particle; pose.size(): the scene
  const Pose& pose;                               ///< of the comoving_frames
};

template <class Real>
class VerletLists {
 public:
  VerletLists() = default;
  VerletLists(const kernel::Functions<Real>& kernel, const PairForce& pair, double step);

  /// The inner list.
  kernel::Lists arrays() const { return inner_.arrays(); }
  bool made() const { return !outer_.first.empty(); }
  /// Makes both lists from nothing.
  void make(const MovingParticles<Real>& particles);
  /// The outer list for another order of the particles, to see whether it is shorter.
  OffsetLists outer_of(BlockState<Real>& state, const Units& units) const;
  double mean_of_outer() const { return outer_.mean(); }

  /// After a step in which no particle was faster than `fastest` (m/s) relative to its
  /// co-moving frame, from the pose told last. False: the lists have to be made anew.
  bool follow(const MovingParticles<Real>& particles, double fastest);
  ListCounts counts() const;

 private:
  double range(double skin, const Units& units) const;
  void add_step(const Pose& pose, double fastest, double rounding);
  void prune(const MovingParticles<Real>& particles);
  bool look(const MovingParticles<Real>& particles);
  std::vector<double> displacements(const MovingParticles<Real>& particles);
  double escaped_beyond(const std::vector<double>& displaced, const Units& units) const;
  std::vector<std::uint32_t> escaped_particles(const MovingParticles<Real>& particles,
                                               const std::vector<double>& displaced, double limit);
  Vec3 place(const MovingParticles<Real>& particles, std::size_t k) const;
  Vec3 place_when_listed(const MovingParticles<Real>& particles, std::size_t k) const;
  void pair_up(const MovingParticles<Real>& particles, std::uint32_t k, double nearer,
               std::vector<BlockOffset>& added) const;
  std::vector<BlockOffset> partners_of(const MovingParticles<Real>& particles,
                                       const std::vector<std::uint32_t>& found,
                                       double nearer) const;
  void anchor(const MovingParticles<Real>& particles, std::uint32_t k);

  kernel::Functions<Real> kernel_{};
  PairForce pair_;
  double step_ = 0;  ///< s

  OffsetLists outer_, inner_;
  BlockCells cells_;
  Contacts contacts_;
  Drift outer_drift_, inner_drift_;
  std::array<std::vector<float>, 3>
      reference_;  ///< places in the comoving_frames' frames, in lengths
  Pose listed_pose_, last_pose_;
  std::vector<RigidMotion> pruned_motions_;
  double moved_when_pruned_ = 0;
  std::unordered_map<std::uint32_t, Vec3>
      escaped_;       ///< where escaped were when the lists were made
  double shift_ = 0;  ///< how far the farthest of them has been anchored from there, m

  ListCounts counts_;
};

}  // namespace sinew
