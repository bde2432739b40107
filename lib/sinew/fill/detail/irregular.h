// SPDX-License-Identifier: GPL-3.0-or-later
// Packings that are no lattice: `random`, without order or direction, and `conformal`, whose outer
// layer follows the surface.
//
//     const Irregular packed = irregular_packing(space, options, filled);
#pragma once

#include <cstdint>
#include <vector>

#include <sinew/core/cell_grid.h>
#include <sinew/fill/detail/isotropy.h>
#include <sinew/fill/filled_sites.h>
#include <sinew/fill/pack.h>

namespace sinew {

struct Irregular {
  Points places;                    ///< in the lattice's coordinates, m
  std::vector<std::int32_t> body;   ///< body of the mesh; 0 where that is open
  NeighborLists touching;           ///< pairs that are nearest neighbors at rest
  std::vector<std::int32_t> group;  ///< connected groups, in the order of their first particle
  std::int32_t groups = 0;
  DirectionalStiffness springs;   ///< stiffness of equal springs between them
  double smallest = 0, mean = 0;  ///< distance to the nearest of them, m
};

/// Packs as many particles in a volume as `filled`, the same body on a lattice, has. The same for
/// any number of threads. Throws bad input where the surface does not allow the packing.
Irregular irregular_packing(const BodySpace& space, const PackOptions& options,
                            const FilledSites& filled);

}  // namespace sinew
