// SPDX-License-Identifier: GPL-3.0-or-later
// The plane by which views cut a body open.
//
//     const DrawnPlane plane(run, turns, options.view);
//     const CutPlane now = plane.at(frame);
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <sinew/core/vector.h>
#include <sinew/run/run_files.h>

namespace sinew {

struct CutPlane {
  Vec3 point = Vec3::Zero();    ///< m
  Vec3 normal = Vec3::UnitY();  ///< toward the part that is left out, of length 1

  double distance(const Vec3& place) const { return normal.dot(place - point); }
};

/// The largest turn of each bone against its parent since rest.
class JointTurns {
 public:
  explicit JointTurns(const RunFiles& run) : run_(&run), turns_(run.skeleton.size()) {}

  void add(const FrameState& frame);

  struct Turn {
    double angle = 0;           ///< rad
    Vec3 axis = Vec3::UnitZ();  ///< axis as the body is at rest
  };
  const std::vector<Turn>& of_bones() const { return turns_; }

 private:
  const RunFiles* run_;
  std::vector<Turn> turns_;
};

class DrawnPlane {
 public:
  /// Stays where it is in space.
  explicit DrawnPlane(const CutPlane& plane) : rest_(plane) {}
  /// Goes through the joint that turns most, the larger its bone's part of the body, along the
  /// bone, and rides on the parent. It is the plane of the bend where the viewer of `view` sees
  /// that, else it faces the viewer. Without such a joint it goes through the body's middle.
  DrawnPlane(const RunFiles& run, const JointTurns& turns, const Mat3& view);

  CutPlane at(const FrameState& frame) const;

 private:
  CutPlane rest_;
  std::optional<std::size_t> bone_;  ///< on which it rides
  RigidFrame bone_rest_;
};

}  // namespace sinew
