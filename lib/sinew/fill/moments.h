// SPDX-License-Identifier: GPL-3.0-or-later
// Volume, centre and inertia of what a surface encloses and of what particles fill.
#pragma once

#include <sinew/core/particles.h>
#include <sinew/core/triangles.h>

namespace sinew {

struct Moments {
  double volume = 0;            ///< m^3
  Vec3 centre = Vec3::Zero();   ///< m
  Mat3 inertia = Mat3::Zero();  ///< about the centre at density 1, m^5

  Vec3 principal() const;  ///< principal moments of inertia, ascending, m^5
};

/// By sums over tetrahedra from the box's centre to the faces. Surfaces without volume have their
/// box's centre.
Moments moments_of(const Triangles& surface);

/// Of points (in particles) that stand for `volume` m^3 each. Each counts as a ball of that volume.
Moments moments_of(const Particles& particles, double volume);

}  // namespace sinew
