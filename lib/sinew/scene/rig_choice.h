// SPDX-License-Identifier: GPL-3.0-or-later
// How a rig comes into a new scene: its axes and scale, so that its bones lie in the mesh, and its
// clip.
//
//     surface = use_rig("walk.bvh", std::move(surface), choices);
#pragma once

#include <string>

#include <sinew/mesh/surface.h>
#include <sinew/scene/new_choices.h>

namespace sinew {

/// The mesh's own path if it holds a rig as well, else "".
std::string rig_within(const std::string& mesh);

/// Sets skeleton, motion, binding and duration. Of the axes that files usually have, and of the
/// scales by which units differ, those count with which most of the bones lies inside the mesh;
/// the mesh may be turned as well: returns its surface. Throws bad input, with the path.
Surface use_rig(const std::string& rig, Surface surface, NewChoices& choices);

}  // namespace sinew
