// SPDX-License-Identifier: GPL-3.0-or-later
// How fast the damping between neighbors stops a free body that turns as a rigid one: eq. 2 pulls
// each particle toward the mean velocity of its neighbors, which at the surface is that of places
// farther inside.
//
//     const double seconds = spin_time(body);
#pragma once

#include <sinew/body/body.h>

namespace sinew {

/// The time in which the spin falls to 1/e, s, about the axis about which it falls fastest, without
/// bones and surroundings; infinite where the damping is central or none.
double spin_time(const Body& body);

}  // namespace sinew
