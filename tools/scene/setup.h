// SPDX-License-Identifier: GPL-3.0-or-later
// From a scene and its filled body to a simulation that can be stepped.
#pragma once

#include "core/particles.h"
#include "core/settings.h"
#include "core/triangles.h"
#include "physics/simulation.h"
#include "physics/time_step.h"

namespace sinew {

struct Setup {
  Body body;
  Motion motion;
  StepChoice steps;
  std::vector<Triangles> obstacles;  ///< of the world, as surfaces about their own middle
  double joint_zone = 0;             ///< in square roots of the bones' cross-section
  bool weights_given = false;        ///< by a file: they spread turns as it pleases
  int frames = 0;  ///< after the first; the last is at solver.duration or just beyond
};

/// Binds the particles to the bones and chooses the step. Errors name the scene's line.
Setup set_up(const Settings& settings, const Particles& particles);

/// The simulation of a setup, at its start. What is given away is not copied.
Simulation start(const Settings& settings, Setup setup, Particles particles);

/// A bound of how far the bones move any particle's place in one step, in radii.
double bone_speed(const Setup& setup, double interval);

}  // namespace sinew
