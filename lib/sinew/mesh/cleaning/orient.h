// SPDX-License-Identifier: GPL-3.0-or-later
// Which side of each patch is outside.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include <sinew/core/options.h>
#include <sinew/mesh/cleaning/patches.h>
#include <sinew/mesh/winding.h>

namespace sinew {

// Which patches bound cavities.

/// Per patch. Those whose volume decides count as shells, closed by their caps. One within another
/// is a cavity of it where the two turn against each other in the file, with the rule `hollow` in
/// any case; within a cavity that makes it a body again.
std::vector<bool> cavities_of(const Triangles& surface, const Patches& patches,
                              const PatchShapes& shapes, FillRule rule);

// Which shells lie within which.

/// A body's or cavity's boundary, outward.
struct Shell {
  std::vector<Corners> faces;
  std::vector<Corners> caps;  ///< close it
};

/// For each box of a shell the next shell outwards, -1 where there is none: the smallest around it
/// whose box holds its box and which holds the middles of its faces (up to 256, spread evenly), not
/// counting those on it. Shells are asked for only where boxes lie in each other.
std::vector<int> next_outer(std::span<const Box> boxes, const std::function<Shell(int)>& shell_of);

/// The faces to reverse for bodies to point outward and cavities into themselves, as clean() says.
/// Patches whose volume says nothing turn or stay as most of the area of the others of their
/// component does, without such as most of all others, without any by the sign of the volume of all
/// faces about the middle of their box.
std::vector<bool> faces_to_turn(const Triangles& surface, std::span<const EdgeUse> uses,
                                const Patches& patches, const Components& components,
                                FillRule rule);

}  // namespace sinew
