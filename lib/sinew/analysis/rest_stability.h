// SPDX-License-Identifier: GPL-3.0-or-later
// Why a packing keeps its shape under the paper's law, or does not: its energy along Bain's path,
// on which FCC becomes BCC as one cube axis shortens. FCC has 12 neighbors at 2 r, and six second
// ones at 2 sqrt(2) r; BCC has 8 and, only 1.15 times as far, six. From b = 2 sqrt(2) r on the
// second neighbors pull, and the more the nearer they come: the energy falls from the start. How
// much it falls is a matter of lambda: with lambda 0.05 by 0.0005 k r^2 per particle, which bones
// hold, with lambda 1 by 0.05 k r^2, and the body collapses.
//
//     const BainPath path = bain_path(material.pair);
//     const bool falls = path.barrier() < path.fall();
#pragma once

#include <vector>

#include <sinew/material/pair_force.h>

namespace sinew {

/// Energies along the path, at the volume where each is least.
struct BainPath {
  /// Energies of a particle, less that of FCC, over k r^2, k the contact stiffness; at even steps
  /// of c/a from sqrt(2), FCC, to 1, BCC.
  std::vector<double> energy;

  /// Returns how far it rises on the way.
  double barrier() const;
  /// Returns how far it is below that of FCC at the end; below 0: above.
  double fall() const { return -energy.back(); }
};

BainPath bain_path(const PairForce& pair, int steps = 40);

/// Whether second neighbors come into the range where a body is strained. Up to b = 2.75 r bodies
/// kept their shape with every lambda from 0.02 to 10.
inline bool second_neighbors_may_pull(const PairForce& pair) {
  return pair.b > 2.75 * pair.r * (1 + 1e-9);
}

}  // namespace sinew
