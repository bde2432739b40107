// SPDX-License-Identifier: GPL-3.0-or-later
// The same body of fewer, larger particles: each site of a coarser packing stands for the particles
// that are nearest to it.
//
//     const Body coarse = coarse_body(body, 2);
#pragma once

#include <sinew/physics/forces.h>

namespace sinew {

/// Particles `times` as large in FCC packing along the body's axes, without bones and world. Its
/// material has the same moduli and density; each particle has the same mass.
Body coarse_body(const Body& body, int times);

}  // namespace sinew
