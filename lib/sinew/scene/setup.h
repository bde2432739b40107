// SPDX-License-Identifier: GPL-3.0-or-later
// Turns a scene and its filled body into a simulation that can be stepped.
//
//     const ReadyScene ready = prepare(settings);
//     Simulation simulation = start(settings, ready);
#pragma once

#include <optional>

#include <sinew/analysis/time_step.h>
#include <sinew/core/particles.h>
#include <sinew/core/surface_look.h>
#include <sinew/core/triangles.h>
#include <sinew/groups/make_grouping.h>
#include <sinew/rig/binding.h>
#include <sinew/scene/body.h>
#include <sinew/scene/machine.h>
#include <sinew/scene/scene_files.h>
#include <sinew/scene/steps.h>
#include <sinew/settings/settings.h>
#include <sinew/stepping/equilibrium.h>
#include <sinew/stepping/simulation.h>

namespace sinew {

// How a scene binds its particles to its bones.

/// Binds particles of `radius` (m) at `rest` as section binding specifies. Throws bad input, with
/// the scene's line: for a file without weights, an unknown bone, numbers of particles that do not
/// exist, and an incomplete box or ball.
Binding bind_scene(const Settings& settings, const SceneFiles& files, const Skeleton& skeleton,
                   const Points& rest, double radius);

/// Returns the material of a scene's particles, a damping ratio apart.
Material material_of(const Settings& settings, const Particles& particles);

/// What differs from particle to particle, as in Body.
struct LocalMaterial {
  std::vector<double> share = {}, stiffness = {};
  std::vector<std::int32_t> component = {};  ///< of each particle; empty: not known
};
LocalMaterial local_material(const BodyFile& body);

/// The particles on the bones, without a world. Errors name the scene's line.
Body make_body(const Settings& settings, const SceneFiles& files, Skeleton skeleton,
               const Particles& particles, LocalMaterial local = {});

struct Setup {
  Body body;
  Motion motion;
  StepChoice steps;
  std::vector<double> bone_speeds;  ///< before each frame, as bone_speeds() finds them, m/s
  StepPlan plan;
  std::optional<LoadSteps> load_steps = {};  ///< of the static method
  std::optional<DynamicOptions> dynamic_groups = {};
  std::vector<Triangles> obstacles;  ///< of the world, as surfaces in coordinates of their shapes
  std::vector<Probe> probes;
  double joint_zone = 0;       ///< in square roots of the bones' cross-section
  bool weights_given = false;  ///< by a file: they distribute rotations in their own manner
  std::vector<std::string> file_warnings = {};  ///< what its files get wrong, with their places
  FrameTimes frames;
};

/// Binds the particles to the bones and chooses the step. Errors name the scene's line.
Setup set_up(const Settings& settings, const SceneFiles& files, const Particles& particles,
             LocalMaterial local = {});

/// A scene filled, bound and ready to be stepped.
struct ReadyScene {
  Surface surface;
  SurfaceLook look;  ///< of the surface, where it is exported
  BodyFile body;
  Setup setup;
  double seconds_filling = 0, seconds_binding = 0;
};

/// Reads the scene's files, fills its mesh (or takes the `body` of an earlier fill), binds the
/// particles and chooses the step. Errors name the scene's line.
ReadyScene prepare(const Settings& settings, std::optional<BodyFile> body = {});

/// The simulation of a scene, at its start.
Simulation start(const Settings& settings, const ReadyScene& ready);

/// The simulation of a setup, at its start. Moved arguments are not copied.
Simulation start(const Settings& settings, Setup setup, Particles particles);

/// The bone with the largest weight for each particle, in the written order.
std::vector<std::int32_t> bones_of_particles(const Body& body);
/// The weight of that bone.
std::vector<double> weights_of_particles(const Body& body);

}  // namespace sinew
