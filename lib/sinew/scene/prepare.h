// SPDX-License-Identifier: GPL-3.0-or-later
// The one door from a scene to a simulation that can be stepped: its files read, its mesh filled,
// the particles bound to the bones, the step chosen.
//
//     Prepared prepared = prepare({read_scene("scene.yaml")});
//     Simulation simulation = start(prepared);
#pragma once

#include <optional>

#include <sinew/analysis/elastic_modes.h>
#include <sinew/analysis/time_step.h>
#include <sinew/core/particles.h>
#include <sinew/core/surface_look.h>
#include <sinew/core/triangles.h>
#include <sinew/fill/fill_report.h>
#include <sinew/groups/make_grouping.h>
#include <sinew/rig/binding.h>
#include <sinew/scene/body_mesh.h>
#include <sinew/scene/filling.h>
#include <sinew/scene/first_pose.h>
#include <sinew/scene/initial_velocities.h>
#include <sinew/scene/intrusions.h>
#include <sinew/scene/machine.h>
#include <sinew/scene/scene_files.h>
#include <sinew/scene/steps.h>
#include <sinew/settings/settings.h>
#include <sinew/stepping/equilibrium.h>
#include <sinew/stepping/simulation.h>

namespace sinew {

/// Returns the material of a scene's particles, a damping ratio apart.
Material material_of(const Settings& settings, const Particles& particles);

/// What differs from particle to particle, as in Body.
struct LocalMaterial {
  std::vector<double> volume_share = {}, stiffness = {};
  std::vector<std::int32_t> component = {};  ///< component of each particle; empty: not known
};
LocalMaterial local_material(const BodyFile& body);

/// The particles on the bones, without a world and a damping ratio. `law`: as Material::law. Errors
/// name the scene's line.
Body make_body(const Settings& settings, const SceneFiles& files, Skeleton skeleton,
               const Particles& particles, LocalMaterial local = {}, const ForceLaw* law = nullptr);

/// What is prepared.
struct Scene {
  Settings settings;
  /// Particles at rest, in place of filling the mesh; what they are of may be another mesh.
  std::optional<BodyFile> filled = {};
  /// Whether the surface of the body is read, which pictures, loads and pressures need; always
  /// where its mesh is filled.
  bool with_surface = true;
  /// In place of the law of material.model, which must have bonds where it has; see Material::law.
  /// Runs do not write it: whoever measures their files takes the model's.
  const ForceLaw* law = nullptr;
  bool with_rig = true;  ///< else without bones, even where nothing surrounds the body
  /// Elastic modes of the body, as Prepared has them, lest they are found again.
  std::optional<ElasticModes> modes = {};
};

/// A scene filled, bound and ready to be stepped.
struct Prepared {
  Settings settings;                      ///< settings, fitted to the rig as skeleton.fit asks
  Surface surface;                        ///< surface of the body; empty: not read
  SurfaceLook look;                       ///< look of the surface, where it is exported
  BodyFile filled;                        ///< the particles at rest, as body.vtu has them
  std::optional<FillReport> report = {};  ///< where the mesh was filled now
  Body body;                              ///< the particles on the bones, in their world
  Motion motion;
  Beginning beginning = {};
  std::vector<Thrown> thrown = {};  ///< what begins with a velocity
  StepChoice steps;
  std::vector<double> bone_speeds;  ///< before each frame, as bone_speeds() finds them, m/s
  StepPlan plan;
  std::optional<LoadSteps> load_steps = {};  ///< load steps of the static method
  std::optional<DynamicOptions> dynamic_groups = {};
  std::vector<Triangles> obstacles;  ///< surfaces of obstacles, in their own coordinates
  std::vector<Probe> probes;
  double joint_zone = 0;                        ///< in square roots of the bones' cross-section
  bool weights_given = false;                   ///< whether a file gives them
  std::vector<std::string> file_warnings = {};  ///< what its files get wrong, with their places
  /// Flesh that passes through flesh: the pairs of body.pass_through, with what was found of them.
  std::vector<Intrusion> passing = {};
  FrameTimes frames;
  std::optional<ElasticModes> modes = {};  ///< modes for which damping was chosen, if it was
  double seconds_filling = 0, seconds_binding = 0;
};

/// Reads the scene's files, fills its mesh, binds the particles and chooses the step. Throws bad
/// input, with the scene's line.
Prepared prepare(Scene scene);

/// The simulation of a prepared scene, at its start. Where that is the first pose, the body is
/// relaxed there first, and has its initial velocities then: leave out `beginning` for what is
/// restored to another moment.
Simulation start(const Prepared& prepared);
/// The same; takes body, motion, plan and particles out of `prepared`, and copies none of them.
/// `progress` hears of the relaxation, if there is one.
Simulation start(Prepared&& prepared, const RelaxationProgress& progress = {});

/// Finds flesh that the motion drives into other flesh, at the moments of frames: of all of them,
/// or of every second, third ... where frames and particles are many.
std::vector<Intrusion> intrusions_of(const Prepared& prepared);

/// The bone with the largest weight for each particle, in the written order.
std::vector<std::int32_t> bones_of_particles(const Body& body);
/// The weight of that bone.
std::vector<double> weights_of_particles(const Body& body);

}  // namespace sinew
