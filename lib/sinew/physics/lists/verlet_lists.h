// SPDX-License-Identifier: GPL-3.0-or-later
// The neighbor lists of a moving body: at every step the inner list holds all pairs within b.
//
// An outer list, found with cells, is valid for long; the inner list, pruned from it, is what the
// kernel traverses. Both are valid until particles have approached by their skins. Approach is
// bounded step by step by the co-moving frames' motions and the fastest particle; when that bound
// is used up, displacements are measured. If that finds a few escaped particles, as in a body that
// flows, they alone get new neighbors; if it finds many, all lists are rebuilt.
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

/// Particles and their co-moving frames at one moment.
template <class Real>
struct MovingParticles {
  BlockState<Real>& state;
  const Units& units;
  kernel::ComovingFrames<Real> comoving_frames;
  std::span<const std::uint32_t> comoving_frame;  ///< by particle; pose.size(): the scene
  const Pose& pose;                               ///< of the co-moving frames
};

template <class Real>
class VerletLists {
 public:
  VerletLists() = default;
  VerletLists(const kernel::Functions<Real>& kernel, const PairForce& pair, double step);

  /// The inner list.
  kernel::Lists arrays() const { return inner_.arrays(); }
  bool made() const { return !outer_.first.empty(); }
  /// Builds both lists.
  void make(const MovingParticles<Real>& particles);
  /// The outer list for another order of the particles, to compare its length.
  OffsetLists outer_of(BlockState<Real>& state, const Units& units) const;
  double mean_of_outer() const { return outer_.mean(); }

  /// After a step in which no particle was faster than `fastest` (m/s) relative to its co-moving
  /// frame, from the pose passed last. False: the lists have to be rebuilt.
  bool follow(const MovingParticles<Real>& particles, double fastest);
  ListCounts counts() const;

 private:
  double range(double skin, const Units& units) const;
  void add_step(const Pose& pose, double fastest, double rounding);
  void prune(const MovingParticles<Real>& particles);
  bool check_displacements(const MovingParticles<Real>& particles);
  std::vector<double> displacements(const MovingParticles<Real>& particles);
  double escaped_beyond(const std::vector<double>& displaced, const Units& units) const;
  std::vector<std::uint32_t> escaped_particles(const MovingParticles<Real>& particles,
                                               const std::vector<double>& displaced, double limit);
  Vec3 place(const MovingParticles<Real>& particles, std::size_t k) const;
  Vec3 place_when_listed(const MovingParticles<Real>& particles, std::size_t k) const;
  void add_pairs(const MovingParticles<Real>& particles, std::uint32_t k, double nearer,
                 std::vector<BlockOffset>& added) const;
  std::vector<BlockOffset> neighbors_of(const MovingParticles<Real>& particles,
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
  /// Coordinates in the co-moving frames, in lengths of the kernel.
  std::array<std::vector<float>, 3> reference_;
  Pose listed_pose_, last_pose_;
  std::vector<RigidMotion> pruned_motions_;
  double moved_when_pruned_ = 0;
  /// Where escaped particles were when the lists were built.
  std::unordered_map<std::uint32_t, Vec3> escaped_;
  double shift_ = 0;  ///< largest distance of their reference from there, m

  ListCounts counts_;
};

}  // namespace sinew
