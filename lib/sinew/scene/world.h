// SPDX-License-Identifier: GPL-3.0-or-later
// The surroundings of a scene's body: the section world, made for its particles and bones.
//
//     body.world = world_of(settings, files, body, components).world;
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <sinew/analysis/time_step.h>
#include <sinew/body/body.h>
#include <sinew/core/triangles.h>
#include <sinew/scene/machine.h>
#include <sinew/scene/scene_files.h>
#include <sinew/settings/settings.h>
#include <sinew/world/obstacle.h>

namespace sinew {

struct SceneWorld {
  std::shared_ptr<const World> world;  ///< none where nothing surrounds the body
  std::vector<Triangles> obstacles;    ///< each as a surface, in coordinates of its shape
  std::vector<Probe> probes;           ///< probes of the body in it
};

/// `body` is complete except for its world; `component`: of each particle. Throws bad input, with
/// the scene's line, for unknown bones, meshes that are open, pins, muscles, supports or loads
/// without particles, and supports that contradict each other.
SceneWorld world_of(const Settings& settings, const SceneFiles& files, const Body& body,
                    std::span<const std::int32_t> component);

/// How keys move something that is at `middle` (m) at rest, turning about it.
ObstacleMotion keyed_motion(const std::string& name, Interpolation interpolation,
                            std::span<const PlaceKeySettings> keys, const Vec3& middle);

/// The stiffness and damping of a body's world, which its step must resolve.
WorldLoad load_of(const Body& body);

}  // namespace sinew
