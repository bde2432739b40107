// SPDX-License-Identifier: GPL-3.0-or-later
// What surrounds the body of a scene: the section world, made for its particles and bones.
#pragma once

#include <memory>
#include <vector>

#include <sinew/core/triangles.h>
#include <sinew/physics/forces.h>
#include <sinew/physics/time_step.h>
#include <sinew/settings/settings.h>

namespace sinew {

struct SceneWorld {
  std::shared_ptr<const World> world;  ///< none for a section that is empty
  std::vector<Triangles> obstacles;    ///< each as a surface, in coordinates of its shape
};

/// `body` is complete but for its world. Throws bad input, naming the scene's line, for unknown
/// bones, meshes that are open or cannot be read, and pins or muscles that have no particles.
SceneWorld world_of(const Settings& settings, const Body& body);

/// What the world of a body adds to what its step must resolve.
WorldLoad load_of(const Body& body);

}  // namespace sinew
