// SPDX-License-Identifier: GPL-3.0-or-later
// How much of the body each particle stands for, over the volume of a particle inside: weights with
// which sums over particles are integrals over the body, exact for linear functions. They begin as
// the part that is nearer to a particle than to any other one; where that reaches far out, its
// neighbors behind lend it some of theirs.
//
//     filling.volume_share = volume_shares(surface, options, space, lattice, owners, volume);
#pragma once

#include <vector>

#include <sinew/fill/detail/owners.h>
#include <sinew/fill/filled_sites.h>
#include <sinew/fill/pack.h>

namespace sinew {

/// In the order of `owners`; 1 where others are all around. Sampled at 81 points a particle, by
/// lattices at an angle to its own that are each other's images under its rotations, so that a body
/// that is turned or mirrored in its lattice has the same shares; to some percent each. `lattice`:
/// FCC, whose unit and origin are those of `owners`. Where the particles fill the mesh's `volume`
/// (m^3; else 0), their sum is that. The same for any number of threads.
std::vector<double> volume_shares(const Surface& surface, const PackOptions& options,
                                  const BodySpace& space, const Lattice& lattice,
                                  const Owners& owners, double volume);

}  // namespace sinew
