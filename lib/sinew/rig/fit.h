// SPDX-License-Identifier: GPL-3.0-or-later
// Brings a skeleton into a mesh that it was not made for: another unit, axis or place.
//
//     const Placement placement = fit_to(surface, skeleton);
//     skeleton = placed(std::move(skeleton), placement);
//
// Improves the best of the 24 rotations that bring axes to axes, and of those that bring the main
// axes of the skeleton to those of the mesh, each with the scale and the place at which the boxes
// of both agree, until the bones lie along the middle of the mesh: the mean squared distance from
// points of the mesh to the nearest bone, and from points of bones that lie outside to the mesh, is
// least. Rotations by less are preferred among nearly equal ones.
#pragma once

#include <sinew/core/options.h>
#include <sinew/core/triangles.h>
#include <sinew/rig/skeleton.h>

namespace sinew {

/// Throws bad input for a mesh or a skeleton of no size.
Placement fit_to(const Triangles& surface, const Skeleton& skeleton);

/// The options with which the skeleton, made with `before`, is placed once more: `then` after them.
SkeletonOptions placed_again(SkeletonOptions before, const Placement& then);

}  // namespace sinew
