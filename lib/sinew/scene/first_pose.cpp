// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/first_pose.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <sinew/analysis/time_step.h>
#include <sinew/core/error.h>
#include <sinew/core/text.h>
#include <sinew/rig/motion_checks.h>
#include <sinew/scene/intrusions.h>
#include <sinew/scene/steps.h>
#include <sinew/scene/world.h>
#include <sinew/stepping/equilibrium.h>
#include <sinew/stepping/simulation.h>

namespace sinew {
namespace {

constexpr double rest_turn = 1, left_rest = 30;  // degrees that a bone turns from rest
constexpr double max_frame = 0.1 + 1e-6;         // s from one frame to the next
constexpr double shortest_step = 0.02;           // s in which nobody turns a bone by 30 degrees
constexpr double far_from_rest = 90;             // degrees, of a bone from rest
constexpr int moments_of_way = 8;
constexpr double residual = 1e-3;
constexpr std::int64_t max_iterations = 3000, iterations_between_reports = 100;

/// Motion without preroll, whose time 0 is that of the clip's start.
Motion from_start(Motion motion) {
  motion.preroll = 0;
  return motion;
}

/// The largest turn of a bone from rest on its parent at the start of a clip, degrees.
double largest_turn(const Skeleton& skeleton, const Motion& motion) {
  double most = 0;
  for (const LocalMotion& one : local_motions(skeleton, from_start(motion), 0))
    most = std::max(most, rotation_vector(one.rotation).norm() + std::abs(one.twist));
  return degrees(most);
}

/// The first key of a clip after a time, s of the clip; none: infinite.
double key_after(const Motion& motion, double after) {
  constexpr double same = 1e-6;  // s
  double next = std::numeric_limits<double>::infinity();
  for (const Track& track : motion.tracks)
    for (const auto* times : {&track.rotation.times, &track.twist.times, &track.translation.times})
      for (const double time : *times)
        if (time > after + same) next = std::min(next, time);
  return next;
}

/// The largest turn of a bone on its parent between two times of a clip, degrees.
double largest_turn(const Skeleton& skeleton, const Motion& clip, double from, double to) {
  const auto there = [&](double time) {
    Motion motion = from_start(clip);
    motion.start = time;
    return local_motions(skeleton, motion, 0);
  };
  const auto before = there(from), after = there(to);
  double most = 0;
  for (std::size_t b = 0; b < before.size(); ++b)
    most = std::max(most, before[b].rotation.angularDistance(after[b].rotation));
  return degrees(most);
}

/// Whether a clip is at rest at its start and not at its second key.
bool leaves_rest(const Skeleton& skeleton, const Motion& clip, const Motion& later) {
  return later.start - clip.start <= max_frame && largest_turn(skeleton, clip) <= rest_turn &&
         largest_turn(skeleton, later) > left_rest;
}

/// Whether a clip jumps faster than anybody moves, and goes on slowly: its first pose is that in
/// which the bones were measured.
bool jumps(const Skeleton& skeleton, const Motion& clip, const Motion& later) {
  const double third = key_after(clip, later.start);
  if (later.start - clip.start > shortest_step || !std::isfinite(third)) return false;
  const double jump = largest_turn(skeleton, clip, clip.start, later.start);
  return jump > left_rest && largest_turn(skeleton, clip, later.start, third) < jump / 3;
}

/// Starts with the second key where the first is the rest pose, or one that nobody comes from, and
/// the second is not.
bool skip_rest(const Skeleton& skeleton, Motion& motion) {
  Motion later = motion;
  later.start = key_after(motion, motion.start);
  if (!std::isfinite(later.start) || (motion.end && later.start >= *motion.end)) return false;
  if (!leaves_rest(skeleton, motion, later) && !jumps(skeleton, motion, later)) return false;
  motion.start = later.start;
  return true;
}

/// Whether flesh passes through flesh on the way from rest to the first pose that is apart there.
bool leads_through_body(const Body& body, Motion motion) {
  motion.preroll = std::max(1.0, preroll_for(body.skeleton, motion));
  const double r = body.material.pair.r;
  std::vector<double> times;
  for (int k = 1; k < moments_of_way; ++k) times.push_back(motion.preroll * k / moments_of_way);
  const double there[] = {motion.preroll};
  const auto in_pose = intrusions(body, motion, there);
  for (const Intrusion& one : intrusions(body, motion, times)) {
    const auto same = std::find_if(in_pose.begin(), in_pose.end(),
                                   [&](const Intrusion& end) { return end.bones == one.bones; });
    const double left = same == in_pose.end() ? 0 : same->depth;
    if (one.depth > std::max(passing_depth * r, left + r)) return true;
  }
  return false;
}

/// Whether a body has a choice, and the scene does not make it.
bool may_be_posed(const Settings& settings) {
  return settings.motion.preroll.value_or(0) == 0 &&
         settings.solver.method != Method::static_equilibrium && !settings.hierarchy.enabled;
}

}  // namespace

bool begins_far_from_rest(const Skeleton& skeleton, Motion clip) {
  return skip_rest(skeleton, clip) || largest_turn(skeleton, clip) > far_from_rest;
}

Beginning begin_of(const Settings& settings, const Body& body, Motion& motion) {
  const Begin begin = settings.motion.begin;
  if (begin == Begin::rest || motion.tracks.empty()) return {};
  if (!may_be_posed(settings)) return {};
  Motion clip = motion;
  const bool skipped = skip_rest(body.skeleton, clip);
  const double turn = largest_turn(body.skeleton, clip);
  std::string why = "the body begins in the first pose";
  if (begin == Begin::automatic) {
    if (turn > far_from_rest)
      why += ", in which a bone is turned by " + three_digits(turn) + " degrees";
    else if (skipped)
      why += ", to which the clip jumps in a frame";
    else if (leads_through_body(body, clip))
      why += ", to which the way from rest leads through the body";
    else
      return {};
  }
  if (skipped)
    why += "; that is the one at " + three_digits(clip.start) + " s of the clip, to which it jumps";
  motion = from_start(std::move(clip));
  return {true, why};
}

Particles posed(const Body& body, const Motion& motion, const Particles& particles,
                const SolverSettings& solver, const RelaxationProgress& progress) {
  Body still = undamped(body);
  Pose pose = pose_at(body.skeleton, motion, 0);
  Particles now = particles;
  const Points places = skinned(body, pose);
  for (std::size_t i = 0; i < now.size(); ++i)
    now.set_position(i, places[static_cast<std::size_t>(now.id[i])]);
  SolverSettings relaxing = solver;
  relaxing.integrator = Integrator::symplectic_euler;
  relaxing.neighbor_search = NeighborSearch::lists;
  const double limit = step_limit(Integrator::symplectic_euler, still, load_of(still));
  Simulation simulation(std::move(still), motion, now,
                        stepping_of(relaxing, relaxing_step_factor * limit));
  LoadSteps once;
  once.residual = residual;
  once.max_iterations = max_iterations;
  once.solver = StaticSolver::relaxation;
  simulation.relax(once);
  try {
    while (simulation.relaxation()->moments() == 0) {
      simulation.step();
      const std::int64_t iterations = simulation.relaxation()->state().iterations;
      if (progress && iterations > 0 && iterations % iterations_between_reports == 0)
        progress(iterations, simulation.relaxation()->residual());
    }
  } catch (const Error& error) {  // not at rest, but nearer to it
    if (error.exit() != Exit::unstable) throw;
  }
  now = simulation.particles();
  for (std::size_t i = 0; i < now.size(); ++i) {
    Vec3 velocity = Vec3::Zero();
    for (const Influence& one : body.binding.of(static_cast<std::size_t>(now.id[i])))
      velocity +=
          one.weight * pose[static_cast<std::size_t>(one.bone)].velocity_at(now.position(i));
    now.set_velocity(i, velocity);
  }
  return now;
}

}  // namespace sinew
