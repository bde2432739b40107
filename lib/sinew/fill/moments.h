// SPDX-License-Identifier: GPL-3.0-or-later
// Volume, center and inertia of the space enclosed by a surface or filled with particles.
//
//     const Vec3 principal = moments_of(surface.triangles).principal();
#pragma once

#include <sinew/core/particles.h>
#include <sinew/core/triangles.h>

namespace sinew {

struct Moments {
  double volume = 0;            ///< m^3
  Vec3 center = Vec3::Zero();   ///< m
  Mat3 inertia = Mat3::Zero();  ///< about the center at density 1, m^5

  Vec3 principal() const;  ///< principal moments of inertia, ascending, m^5
};

/// Sums over tetrahedra from the box's center to the faces: the center of surfaces without volume.
Moments moments_of(const Triangles& surface);

/// Sums over particles, as balls of `volume` (m^3) each.
Moments moments_of(const Particles& particles, double volume);

}  // namespace sinew
