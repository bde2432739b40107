// SPDX-License-Identifier: GPL-3.0-or-later
// Stepping without a neighbor search: all pairs, O(n^2). The baseline for the paper's cells.
#pragma once

#include <sinew/stepping/simulation.h>

namespace sinew::bench {

/// Pair forces and damping (the paper's form) of all pairs. Fills pair, damping and neighbors.
void all_pair_forces(const Particles& particles, const Material& material, Forces& forces);

/// One step of symplectic Euler, s.
void step_all_pairs(Particles& particles, const Body& body, const Pose& pose, double step,
                    Forces& forces);

}  // namespace sinew::bench
