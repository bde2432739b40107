// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/setup.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "physics/thin_body.h"
#include "rig/pose_cursor.h"
#include "scene/binding.h"
#include "scene/body.h"
#include "scene/rig.h"
#include "scene/world.h"

namespace sinew {
namespace {

constexpr double most_steps = 2e9;  // files count them in 32 bits

int frames_of(const Settings& settings) {
  const double frames = std::ceil(settings.solver.duration / settings.output.interval - 1e-6);
  if (!(frames <= 1e6))
    throw bad_input(settings.place("solver.duration"), "the run would have over a million frames",
                    "make output.interval longer");
  return static_cast<int>(frames);
}

BodyShape shape_of(const Settings& settings, const Points& rest, const Particles& particles) {
  BodyShape shape = sinew::shape_of(rest, particles.radius, particles.mass);
  shape.lattice = lattice_axes(settings.body);
  return shape;
}

Body make_body(const Settings& settings, const Skeleton& skeleton, const Particles& particles) {
  Body body;
  body.rest = positions_of(particles);
  body.skeleton = skeleton;
  body.binding = bind_scene(settings, body.skeleton, body.rest, particles.radius);
  body.material = make_material(settings.material, shape_of(settings, body.rest, particles));
  body.springs = bone_springs(settings.binding, body.material, body.binding, body.skeleton);
  return body;
}

StepChoice steps_of(const Settings& settings, const Body& body) {
  const double limit = step_limit(settings.solver.integrator, body, load_of(body));
  try {
    return choose_step(settings.solver, limit, settings.output.interval);
  } catch (const Error& error) {
    throw error.within(settings.place("solver.integrator"));
  }
}

}  // namespace

Setup set_up(const Settings& settings, const Particles& particles) {
  Setup setup;
  setup.frames = frames_of(settings);
  SceneRig rig = rig_of(settings);
  setup.body = make_body(settings, rig.skeleton, particles);
  SceneWorld around = world_of(settings, setup.body);
  setup.body.world = std::move(around.world);
  setup.obstacles = std::move(around.obstacles);
  setup.motion = std::move(rig.motion);
  setup.joint_zone = settings.binding.joint_zone;
  setup.weights_given = settings.binding.method == BindMethod::file;
  setup.steps = steps_of(settings, setup.body);
  if (static_cast<double>(setup.frames) * setup.steps.per_frame > most_steps)
    throw bad_input(settings.place("solver.duration"), "the run would take over 2e9 steps",
                    "make solver.duration shorter or solver.time_step longer");
  return setup;
}

Simulation start(const Settings& settings, Setup setup, Particles particles) {
  return Simulation(std::move(setup.body), std::move(setup.motion), std::move(particles),
                    stepping_of(settings.solver, setup.steps.step));
}

double bone_speed(const Setup& setup, double interval) {
  const Body& body = setup.body;
  std::vector<double> reach(body.skeleton.size(), 0.0);  // from the bone's axis
  for (const Influence& influence : body.binding.influences)
    reach[influence.bone] = std::max(reach[influence.bone], influence.rest_distance);
  double fastest = 0;
  constexpr int samples_per_frame = 4;
  PoseCursor poses(body.skeleton, setup.motion);
  for (int sample = 0; sample <= samples_per_frame * setup.frames; ++sample) {
    const Pose& pose = poses.at(sample * interval / samples_per_frame);
    for (std::size_t b = 0; b < pose.size(); ++b) {
      const double length = pose[b].stretch * body.skeleton.bones[b].length;
      const Vec3 tail = pose[b].frame.origin + length * pose[b].axis();
      const double spin = pose[b].angular_velocity.norm() * reach[b];
      fastest = std::max(
          {fastest, pose[b].velocity.norm() + spin, pose[b].velocity_at(tail).norm() + spin});
    }
  }
  return fastest * setup.steps.step / body.material.pair.r;
}

}  // namespace sinew
