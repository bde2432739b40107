// SPDX-License-Identifier: GPL-3.0-or-later
// Whether bones, pins and supports restrain every rigid motion of a body and of each of its
// components: what is free to move as a whole has no equilibrium of its own.
//
//     if (const auto free = free_motion(body)) refuse(free->text());
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <sinew/body/body.h>

namespace sinew {

/// A rigid motion that nothing restrains, of a connected component of the body.
struct FreeMotion {
  Vec3 translation = Vec3::Zero();  ///< motion of the center; of length 1, or 0 for a rotation
  Vec3 axis = Vec3::Zero();         ///< axis of a rotation about the center, of length 1
  Vec3 center = Vec3::Zero();       ///< center of the component, m
  std::size_t particles = 0;        ///< in the component
  bool whole = true;                ///< the component is the whole body

  /// "the body can move along [1, 0, 0]"
  std::string text() const;
};

/// The first one, at rest; none where all are restrained. A bone restrains a particle along those
/// directions along which it has springs. Particles are connected where they are neighbors at rest.
std::optional<FreeMotion> free_motion(const Body& body);

}  // namespace sinew
