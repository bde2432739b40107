// SPDX-License-Identifier: GPL-3.0-or-later
// Volume, center and inertia of what a surface encloses and of what particles fill.
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

/// By sums over tetrahedra from the box's center to the faces. Surfaces without volume have their
/// box's center.
Moments moments_of(const Triangles& surface);

/// Of points (in particles) that stand for `volume` m^3 each. Each counts as a ball of that volume.
Moments moments_of(const Particles& particles, double volume);

}  // namespace sinew
