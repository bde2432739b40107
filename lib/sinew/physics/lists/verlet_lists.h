// SPDX-License-Identifier: GPL-3.0-or-later
// The lists of partners of a moving body, kept true: at every step they hold all pairs within b.
//
// A wide list, found with the cells, lasts long; a narrow one, sifted from it, is what the kernel
// works through. Both hold until particles have approached by their skins, judged by what the
// carriers' motions and the fastest particle allow, step by step, and by a look at all particles
// when that is used up. A look that finds a few particles astray, as in a body that flows, gives
// those alone new partners; when there are many, all lists are made anew.
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
struct Riders {
  BlockState<Real>& state;
  const Measure& measure;
  kernel::Carriers<Real> carriers;
  std::span<const std::uint32_t> carrier;  ///< by particle; pose.size(): the scene
  const Pose& pose;                        ///< of the carriers
};

template <class Real>
class PartnerLists {
 public:
  PartnerLists() = default;
  PartnerLists(const kernel::Functions<Real>& kernel, const PairForce& pair, double step);

  /// The narrow list.
  kernel::Lists arrays() const { return narrow_.arrays(); }
  bool made() const { return !wide_.first.empty(); }
  /// Makes both lists from nothing.
  void make(const Riders<Real>& riders);
  /// The wide list for another order of the particles, to see whether it is shorter.
  OffsetLists wide_of(BlockState<Real>& state, const Measure& measure) const;
  double mean_of_wide() const { return wide_.mean(); }

  /// After a step in which no particle was faster than `fastest` (m/s) relative to its
  /// carrier, from the pose told last. False: the lists have to be made anew.
  bool follow(const Riders<Real>& riders, double fastest);
  ListCounts counts() const;

 private:
  double range(double skin, const Measure& measure) const;
  void add_step(const Pose& pose, double fastest, double rounding);
  void sift(const Riders<Real>& riders);
  bool look(const Riders<Real>& riders);
  std::vector<double> displacements(const Riders<Real>& riders);
  double astray_beyond(const std::vector<double>& displaced, const Measure& measure) const;
  std::vector<std::uint32_t> strays(const Riders<Real>& riders,
                                    const std::vector<double>& displaced, double limit);
  Vec3 place(const Riders<Real>& riders, std::size_t k) const;
  Vec3 place_when_listed(const Riders<Real>& riders, std::size_t k) const;
  void pair_up(const Riders<Real>& riders, std::uint32_t k, double nearer,
               std::vector<BlockOffset>& added) const;
  std::vector<BlockOffset> partners_of(const Riders<Real>& riders,
                                       const std::vector<std::uint32_t>& found,
                                       double nearer) const;
  void anchor(const Riders<Real>& riders, std::uint32_t k);

  kernel::Functions<Real> kernel_{};
  PairForce pair_;
  double step_ = 0;  ///< s

  OffsetLists wide_, narrow_;
  BlockCells cells_;
  Contacts contacts_;
  Drift wide_drift_, narrow_drift_;
  std::array<std::vector<float>, 3> reference_;  ///< places in the carriers' frames, in lengths
  Pose listed_pose_, last_pose_;
  std::vector<RigidMotion> sifted_motions_;
  double moved_when_sifted_ = 0;
  std::unordered_map<std::uint32_t, Vec3> strayed_;  ///< where strays were when the lists were made
  double shift_ = 0;  ///< how far the farthest of them has been anchored from there, m

  ListCounts counts_;
};

}  // namespace sinew
