// SPDX-License-Identifier: GPL-3.0-or-later
// The rigid frames relative to which approach is judged: those of the bones, frames between bones
// that meet, and the scene's. Particles that move with their frame do not invalidate lists. Tissue
// around a bent joint follows neither of its bones; frames with a share of the rotation between
// them follow it more closely.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <sinew/physics/forces.h>
#include <sinew/physics/kernel/kernel.h>
#include <sinew/physics/lists/block_state.h>
#include <sinew/rig/pose.h>

namespace sinew {

class ComovingFrames {
 public:
  ComovingFrames() = default;
  explicit ComovingFrames(const Body& body);

  /// Chooses a frame for each particle of `state`: that of its leading bone or, where particles as
  /// far from a joint have rotated differently since the rest pose, one between the bones that meet
  /// there. `id` by particle.
  template <class Real>
  void choose(const Body& body, const Pose& bones, const BlockState<Real>& state,
              const Units& units, std::span<const std::int32_t> id);

  /// By particle: its frame in `at`; the size of that for a particle without a bone.
  std::span<const std::uint32_t> of_particles() const { return of_; }
  /// The bones' frames, then those between bones that particles follow.
  Pose at(const Pose& bones) const;

 private:
  /// The joint of a bone with its parent.
  struct Hinge {
    std::size_t parent, child;
    Vec3 place, axis;       ///< at rest; the axis, of unit length, points into the child
    double before, beyond;  ///< how far along it, m, particles of the two bones reach
    double width;           ///< extent of the tissue around, in diameters
  };
  struct Between {
    std::size_t hinge;
    double share;  ///< of the rotation from parent to child
  };
  class Profile;

  template <class Real>
  std::vector<Profile> profiles(const Body& body, const Pose& bones, const BlockState<Real>& state,
                                const Units& units, std::span<const std::int32_t> id) const;
  std::uint32_t choice(int bone, const Vec3& rest, std::span<const Profile> profiles,
                       std::size_t bones) const;
  BonePose pose_of(const Between& between, const Pose& bones) const;
  /// Drops the frames that no particle follows.
  void compress(std::span<const Profile> profile, std::size_t bones);

  std::vector<Hinge> hinges_;
  std::vector<std::vector<std::size_t>> hinges_of_;  ///< by bone
  std::vector<Between> between_;
  std::vector<std::uint32_t> of_;
};

/// The co-moving frames in the kernel's layout.
template <class Real>
struct FrameSlots {
  std::vector<std::uint32_t> first;  ///< blocks + 1 long
  std::vector<kernel::FrameSlot> slots;
  std::vector<Real> lanes;
};

template <class Real>
FrameSlots<Real> frame_slots(std::span<const std::uint32_t> comoving_frame);

}  // namespace sinew
