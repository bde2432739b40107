// SPDX-License-Identifier: GPL-3.0-or-later
// A rigid frame: where something is and how it is turned.
#pragma once

#include "core/vector.h"

namespace sinew {

/// Maps local x to origin + rotation x.
struct RigidFrame {
  Vec3 origin = Vec3::Zero();        ///< m
  Mat3 rotation = Mat3::Identity();  ///< columns are the frame's axes
};

/// A point fixed to a frame: where it is now when it was at `point` as the frame was at `rest`.
inline Vec3 carried(const Vec3& point, const RigidFrame& rest, const RigidFrame& now) {
  return now.origin + now.rotation * (rest.rotation.transpose() * (point - rest.origin));
}

}  // namespace sinew
