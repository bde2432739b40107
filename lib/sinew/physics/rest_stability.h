// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a packing keeps its shape by itself under a law of force: small strains must raise the
// energy of a free cluster.
//
// A ball of 5 r is strained at random, as a whole and each particle by itself, by 1e-3 to 1e-2. A
// law fails where partners come within reach that pull with a falling force, as second neighbors
// at 2 sqrt(2) r do from that b on, or where stretched pairs do not pull at all (a above 2 r).
// Strains, not the stiffness at rest, because eq. 1 changes its slope where its range ends.
#pragma once

#include <sinew/core/options.h>
#include <sinew/physics/material.h>

namespace sinew {

/// The least that a strain raises the energy of the cluster, per particle over
/// k (strain r)^2 / 2; below 0 the packing collapses or swells.
double least_rise(const Material& material, Packing packing);

/// Whether the law holds FCC and HCP.
bool rests_stably(const Material& material);

}  // namespace sinew
