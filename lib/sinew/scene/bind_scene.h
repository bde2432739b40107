// SPDX-License-Identifier: GPL-3.0-or-later
// How a scene binds its particles to its bones: by section binding, the weights of a skin in the
// rig's file, and entries of binding.explicit. A skin's weights hold between its vertices as well:
// they are linear over its triangles, however large these are.
//
//     const Binding binding = bind_scene(settings, files, skeleton, rest, nearest, radius);
#pragma once

#include <sinew/core/cell_grid.h>
#include <sinew/rig/binding.h>
#include <sinew/scene/scene_files.h>
#include <sinew/settings/settings.h>

namespace sinew {

/// Binds particles of `radius` (m) at `rest`, with their nearest neighbors, as section binding
/// specifies. Throws bad input, with the scene's line: for a file without weights, an unknown bone,
/// numbers of particles that do not exist, and an incomplete box or ball.
Binding bind_scene(const Settings& settings, const SceneFiles& files, const Skeleton& skeleton,
                   const Points& rest, const NeighborLists& nearest, double radius);

}  // namespace sinew
