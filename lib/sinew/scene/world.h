// SPDX-License-Identifier: GPL-3.0-or-later
// The surroundings of a scene's body: the section world, made for its particles and bones.
//
//     body.world = world_of(settings, files.obstacles, body).world;
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <sinew/core/triangles.h>
#include <sinew/mesh/surface.h>
#include <sinew/physics/forces.h>
#include <sinew/physics/time_step.h>
#include <sinew/settings/settings.h>

namespace sinew {

struct SceneWorld {
  std::shared_ptr<const World> world;  ///< none for a section that is empty
  std::vector<Triangles> obstacles;    ///< each as a surface, in coordinates of its shape
};

/// `meshes`: of the obstacles, one each. `body` is complete except for its world. Throws bad input,
/// with the scene's line, for unknown bones, meshes that are open, and pins or muscles without
/// particles.
SceneWorld world_of(const Settings& settings, std::span<const Surface> meshes, const Body& body);

/// The stiffness and damping of a body's world, which its step must resolve.
WorldLoad load_of(const Body& body);

}  // namespace sinew
