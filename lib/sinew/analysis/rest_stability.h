// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a packing keeps its shape at rest under a law of force: small strains must raise the
// energy of a free cluster.
//
// A ball of radius 5 r is strained at random, as a whole and particle by particle, by 1e-3 to 1e-2.
// A law fails where further neighbors come into range and pull with a decreasing force, as the
// second neighbors at 2 sqrt(2) r do from that b on, or where stretched pairs do not pull at all (a
// above 2 r). Strains, not the stiffness at rest, because the slope of eq. 1 is discontinuous where
// its range ends.
//
//     const bool stable = rests_stably(material);
#pragma once

#include <sinew/core/options.h>
#include <sinew/material/material.h>

namespace sinew {

/// The least rise of the cluster's energy by a strain, per particle, over k (strain r)^2 / 2; below
/// 0 the packing collapses or swells.
double min_rise(const Material& material, Packing packing);

/// Whether FCC and HCP are stable at rest.
bool rests_stably(const Material& material);

}  // namespace sinew
