// SPDX-License-Identifier: GPL-3.0-or-later
// Orients a surface: decides which side of each patch is outside.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include <sinew/core/options.h>
#include <sinew/mesh/detail/patches.h>
#include <sinew/mesh/winding.h>

namespace sinew {

/// Per patch, whether it bounds a cavity. Those whose volume decides count as shells, closed by
/// their caps. One inside another is a cavity of it where their orientations in the file are
/// opposite, with the rule `hollow` in any case; inside a cavity that makes it a body again.
std::vector<bool> cavities_of(const Triangles& surface, const Patches& patches,
                              const PatchShapes& shapes, FillRule rule);

// The nesting of shells.

/// A body's or cavity's boundary, outward.
struct Shell {
  std::vector<Corners> faces;
  std::vector<Corners> caps;  ///< close it
};

/// For each box of a shell the next shell outward, -1 where there is none: the smallest whose box
/// contains its box and which contains the centers of its faces (up to 256, spread evenly), not
/// counting those on it. shell_of() is called only where boxes are nested.
std::vector<int> next_outer(std::span<const Box> boxes, const std::function<Shell(int)>& shell_of);

/// Whether the centers of faces (up to 256, spread evenly) are inside, without those on `outer`.
bool encloses(const Winding& outer, std::span<const Corners> faces);

/// The faces to reverse for bodies to point outward and cavities into themselves, as clean() says.
/// Patches whose volume does not decide follow most of the area of the others in their component;
/// without such, most of all others; without any, the sign of the volume of all faces about the
/// center of their box.
std::vector<bool> faces_to_turn(const Triangles& surface, std::span<const EdgeUse> uses,
                                const Patches& patches, const Components& components,
                                FillRule rule);

}  // namespace sinew
