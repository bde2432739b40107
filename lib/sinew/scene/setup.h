// SPDX-License-Identifier: GPL-3.0-or-later
// From a scene and its filled body to a simulation that can be stepped.
#pragma once

#include <optional>

#include <sinew/core/particles.h>
#include <sinew/core/triangles.h>
#include <sinew/physics/simulation.h>
#include <sinew/physics/time_step.h>
#include <sinew/rig/binding.h>
#include <sinew/scene/body.h>
#include <sinew/settings/settings.h>

namespace sinew {

// How a scene binds its particles to its bones.

/// Binds particles of `radius` (m) at `rest` as section binding says. Throws bad input, naming the
/// scene's line: for weights of a file without any, a bone without a name of the skeleton, numbers
/// of particles that are not there, and half a box or ball.
Binding bind_scene(const Settings& settings, const Skeleton& skeleton, const Points& rest,
                   double radius);

struct Setup {
  Body body;
  Motion motion;
  StepChoice steps;
  std::vector<Triangles> obstacles;  ///< of the world, as surfaces about their own middle
  double joint_zone = 0;             ///< in square roots of the bones' cross-section
  bool weights_given = false;        ///< by a file: they spread turns as it pleases
  int frames = 0;  ///< after the first; the last is at solver.duration or just beyond
};

/// What the section solver says of stepping, with the step chosen for it, s.
Stepping stepping_of(const SolverSettings& solver, double step);
StepChoice choose_step(const SolverSettings& solver, double limit, double interval);

/// Binds the particles to the bones and chooses the step. Errors name the scene's line.
Setup set_up(const Settings& settings, const Particles& particles);

/// A scene filled, bound and ready to be stepped.
struct ReadyScene {
  Surface surface;
  BodyFile body;
  Setup setup;
  double seconds_filling = 0, seconds_binding = 0;
};

/// Reads the scene's mesh, fills it (or takes the `body` that an earlier fill has left), binds the
/// particles and chooses the step. Errors name the scene's line.
ReadyScene prepare(const Settings& settings, std::optional<BodyFile> body = {});

/// The simulation of a scene, at its start.
Simulation start(const Settings& settings, const ReadyScene& ready);

/// The simulation of a setup, at its start. What is given away is not copied.
Simulation start(const Settings& settings, Setup setup, Particles particles);

/// A bound of how far the bones move any particle's place in one step, in radii.
double bone_speed(const Setup& setup, double interval);

/// The bone that holds each particle most, in the written order.
std::vector<std::int32_t> bones_of_particles(const Body& body);
/// That bone's share in it.
std::vector<double> weights_of_particles(const Body& body);

}  // namespace sinew
