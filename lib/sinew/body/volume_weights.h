// SPDX-License-Identifier: GPL-3.0-or-later
// How stiffly each particle keeps its volume (bonded_volume, see solid.h). With A = sum X X^T over
// the vectors to its nearest neighbors, w = min(1, lambda_min(A) / (4 d0^2))^2: a particle of a
// surface has few neighbors, and with the weight of one inside would halve the step. What its
// weight lacks of its volume share, particles further inside take over, layer by layer, as far
// as the step allows: all weights sum to the body's volume, but in bodies of a few layers.
//
// A slab of 9, 15 and 21 layers (along cube axes) that bends in plane strain has so much of the
// stiffness of a plate:
//   Poisson's ratio 0.4                    0.917, 0.966, 0.982
//   the same, where none takes over        0.894, 0.946, 0.965
//   bonds alone, of a ratio of 0.25        0.950, 0.979, 0.988
//
//     const auto weights = volume_weights(rest, near.nearest, material, volume_share);
#pragma once

#include <vector>

#include <sinew/core/cell_grid.h>
#include <sinew/core/particles.h>
#include <sinew/material/material.h>

namespace sinew {

/// w of particles of `radius` (m) with that A (m^2), before any takes over from others.
double volume_weight(const Mat3& A, double radius);

/// Returns w of each particle at `rest` (m) with its nearest neighbors.
std::vector<double> own_volume_weights(const Points& rest, const NeighborLists& nearest,
                                       double radius);

/// No particle has more than this many times the weight of one inside: 2, or with which waves take
/// as short a step as modes at surfaces do anyway.
double max_volume_weight(const Material& material);

/// Returns the weights of particles at `rest` (m) with their nearest neighbors, and `volume_share`
/// as in bond_factors(). Where second neighbors have no bonds, none takes over.
std::vector<double> volume_weights(const Points& rest, const NeighborLists& nearest,
                                   const Material& material,
                                   const std::vector<double>& volume_share);

}  // namespace sinew
