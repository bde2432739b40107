// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/steps.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/error.h>
#include <sinew/core/text.h>
#include <sinew/rig/motion.h>
#include <sinew/scene/prepare.h>
#include <sinew/scene/world.h>
#include <sinew/world/world.h>

namespace sinew {

Stepping stepping_of(const SolverSettings& solver, double step) {
  return {solver.integrator, step, solver.gravity, solver.precision, solver.neighbor_search};
}

StepChoice choose_step(const SolverSettings& solver, double limit, double interval) {
  return choose_step(solver.time_step, solver.time_step_factor, limit, interval);
}

namespace {

/// Frames are single steps of a plan, each of which takes many iterations of this step.
StepChoice relaxing_steps(double limit) {
  StepChoice choice;
  choice.limit = limit;
  choice.step = relaxing_step_factor * limit;
  choice.per_frame = 1;
  return choice;
}

}  // namespace

bool grows(const Settings& settings, const Body& body) {
  return settings.solver.integrator == Integrator::explicit_euler &&
         !(step_limit(Integrator::explicit_euler, body, load_of(body)) > 0);
}

StepChoice steps_of(const Settings& settings, const Body& body) {
  double limit = step_limit(settings.solver.integrator, body, load_of(body));
  if (grows(settings, body))
    limit = explicit_step_for(body, load_of(body), settings.solver.duration);
  if (!(limit > 0) && settings.solver.integrator != Integrator::explicit_euler)
    throw bad_input(settings.place("material.density"),
                    "no time step is short enough for particles of " +
                        three_digits(body.material.mass) + " kg on springs of " +
                        three_digits(body.material.stiffness()) + " N/m",
                    "give the material a density and a modulus of real ones, as 1000 kg/m^3 and "
                    "1e4 Pa");
  if (settings.solver.method == Method::static_equilibrium) return relaxing_steps(limit);
  try {
    return choose_step(settings.solver, limit, settings.output.interval);
  } catch (const Error& error) {
    throw error.with_context(settings.place("solver.integrator"));
  }
}

namespace {

/// Finds the farthest from its axis that each bone holds a particle, m.
std::vector<double> reach_of_bones(const Body& body) {
  std::vector<double> reach(body.skeleton.size(), 0.0);
  for (std::size_t i = 0; i < body.rest.size(); ++i)
    for (const Influence& influence : body.binding.of(i)) {
      const Bone& bone = body.skeleton.bones[influence.bone];
      double& farthest = reach[influence.bone];
      farthest = std::max(farthest, influence.distance_to(bone, body.rest[i]));
    }
  return reach;
}

struct BoneEnds {
  Vec3 head, tail;
};

/// The farthest from its pivot that a support holds a particle, m.
double reach_of(const Support& support, const Points& rest) {
  double reach = 0;
  for (const std::uint32_t i : support.particles)
    reach = std::max(reach, (rest[i] - support.pivot).norm());
  return reach;
}

/// The farthest that a frame carries what is within reach of it, m.
double carried(const ObstaclePose& from, const ObstaclePose& to, double reach) {
  const Mat3 turn = to.frame.rotation * from.frame.rotation.transpose();
  return (to.frame.origin - from.frame.origin).norm() + Eigen::AngleAxisd(turn).angle() * reach;
}

/// How fast bones and supports move at moments one after the other, as their velocities say, and as
/// they have moved since the last: those of a body that is brought to rest have no velocities.
class Speedometer {
 public:
  /// Before the first moment, at 0, bones were at rest for `between` s, unless the body begins in
  /// their first pose: they may begin elsewhere.
  Speedometer(const Prepared& prepared, double between)
      : skeleton_(prepared.body.skeleton),
        world_(prepared.body.world),
        rest_(prepared.body.rest),
        reach_(reach_of_bones(prepared.body)),
        poses_(prepared.body.skeleton, prepared.motion),
        time_(-between) {
    for (const Bone& bone : skeleton_.bones) last_.push_back({bone.head(), bone.tail()});
    if (prepared.beginning.posed) last_ = ends_at(0);
    if (!world_) return;
    for (const Support& support : world_->supports)
      reach_of_supports_.push_back(reach_of(support, rest_));
  }

  /// The fastest that any particle is carried, m/s.
  double at(double time) {
    const Pose& pose = poses_.at(time);
    double fastest = 0;
    for (std::size_t b = 0; b < pose.size(); ++b) {
      const BoneEnds ends = ends_of(b, pose[b]);
      const double spin = pose[b].angular_velocity.norm() * reach_[b];
      fastest = std::max({fastest, pose[b].velocity.norm() + spin,
                          pose[b].velocity_at(ends.tail).norm() + spin, moved(b, ends, time)});
      last_[b] = ends;
    }
    fastest = std::max(fastest, speed_of_supports(time, pose));
    time_ = time;
    return fastest;
  }

 private:
  BoneEnds ends_of(std::size_t bone, const BonePose& now) const {
    const double length = now.stretch * skeleton_.bones[bone].length;
    return {now.frame.origin, now.frame.origin + length * now.axis()};
  }

  std::vector<BoneEnds> ends_at(double time) {
    std::vector<BoneEnds> ends;
    for (const BonePose& now : poses_.at(time)) ends.push_back(ends_of(ends.size(), now));
    return ends;
  }

  double speed_of_supports(double time, const Pose& pose) {
    if (!world_) return 0;
    std::vector<ObstaclePose> now;
    double fastest = 0;
    for (std::size_t k = 0; k < world_->supports.size(); ++k) {
      const ObstacleMotion& motion = world_->supports[k].motion;
      now.push_back(motion ? motion(time, pose) : ObstaclePose{});
      const double reach = reach_of_supports_[k];
      fastest = std::max(fastest, now[k].velocity.norm() + now[k].angular_velocity.norm() * reach);
      if (!last_supports_.empty())
        fastest = std::max(fastest, carried(last_supports_[k], now[k], reach) / (time - time_));
    }
    last_supports_ = std::move(now);
    return fastest;
  }

  double moved(std::size_t bone, const BoneEnds& ends, double time) const {
    return std::max((ends.head - last_[bone].head).norm(), (ends.tail - last_[bone].tail).norm()) /
           (time - time_);
  }

  const Skeleton& skeleton_;
  std::shared_ptr<const World> world_;
  const Points& rest_;
  std::vector<double> reach_;
  PoseCursor poses_;
  std::vector<double> reach_of_supports_;  ///< m
  std::vector<BoneEnds> last_;
  std::vector<ObstaclePose> last_supports_;
  double time_;  ///< time of the last, s
};

}  // namespace

FrameTimes frame_times(const Settings& settings) {
  FrameTimes times{settings.output.interval, settings.solver.duration};
  const double frames = std::ceil(times.end / times.interval - FrameTimes::negligible);
  if (!(frames <= 1e6))
    throw bad_input(settings.place("solver.duration"), "the run would have over a million frames",
                    "make output.interval longer");
  times.count = static_cast<int>(frames);
  return times;
}

std::vector<double> bone_speeds(const Prepared& prepared) {
  constexpr int samples = 8;  // per interval: clips have up to 120 frames per second
  std::vector<double> speeds;
  const FrameTimes& frames = prepared.frames;
  Speedometer bones(prepared, frames.interval / samples);
  double last = bones.at(0);
  for (int frame = 0; frame < frames.count; ++frame) {
    double fastest = last;
    const double fraction = frames.before(frame + 1) / frames.interval;
    for (int sample = 1; sample <= samples; ++sample) {
      last = bones.at((frame + fraction * sample / samples) * frames.interval);
      fastest = std::max(fastest, last);
    }
    speeds.push_back(fastest);
  }
  return speeds;
}

namespace {

/// The time in which a wave crosses the body, s: about as long what a bone has set in motion goes
/// on after the bone has stopped.
double crossing_time(const Body& body) {
  const double r = body.material.pair.r;
  const double wave_speed = 2 * r * std::sqrt(body.material.stiffness() / body.material.mass);
  return bounds(body.rest).diagonal().norm() / wave_speed;
}

}  // namespace

namespace {

/// Into how many parts the steps before each frame are divided.
std::vector<int> parts_of_steps(const Prepared& prepared) {
  const double kept =
      std::exp(-prepared.frames.interval / crossing_time(prepared.body));  // decay of a speed
  std::vector<int> parts;
  double speed = 0;
  for (const double of_bones : prepared.bone_speeds) {
    speed = std::max(of_bones, kept * speed);
    const double carried = speed * prepared.steps.step / prepared.body.material.pair.r;
    parts.push_back(static_cast<int>(std::clamp(std::ceil(carried / max_carried), 1.0, 1e6)));
  }
  return parts;
}

}  // namespace

StepPlan plan_of(const Settings& settings, const Prepared& prepared) {
  const StepChoice& steps = prepared.steps;
  const FrameTimes& frames = prepared.frames;
  std::vector<int> parts(static_cast<std::size_t>(frames.count), 1);
  std::optional<WholeSteps> last;
  if (settings.solver.method == Method::static_equilibrium) {
    if (frames.is_cut(frames.count)) last = WholeSteps{1, frames.before(frames.count)};
    return StepPlan(frames.interval, 1, std::move(parts), last);
  }
  if (!settings.solver.time_step) parts = parts_of_steps(prepared);
  if (frames.is_cut(frames.count)) {
    const auto choice = choose_step(steps.step, 1, steps.limit, frames.before(frames.count));
    last = WholeSteps{choice.per_frame, choice.step};
  }
  return StepPlan(steps.step, steps.per_frame, std::move(parts), last);
}

namespace {

/// Whether anything but bones and supports changes from one time to another.
bool changes(const Body& body, double from, double to) {
  if (!body.world) return false;
  const Pose at_rest = rest_pose(body.skeleton);
  const WorldNow a = world_at(*body.world, from, at_rest), b = world_at(*body.world, to, at_rest);
  const auto moved = [](const ObstaclePose& one, const ObstaclePose& other) {
    return one.frame.origin == other.frame.origin && one.frame.rotation == other.frame.rotation;
  };
  return a.loads != b.loads || a.scales != b.scales || a.activations.level != b.activations.level ||
         !std::equal(a.obstacles.begin(), a.obstacles.end(), b.obstacles.begin(), moved);
}

}  // namespace

namespace {

/// Chooses how equilibria are found. Newton's method is refused where it is asked for and does not
/// apply.
void choose_static_solver(const Settings& settings, const Prepared& prepared, LoadSteps& steps) {
  using enum StaticSolver;
  constexpr double clearly = 2;  // faster: both are estimates
  constexpr double quick = 1;    // a relaxation, s: the factor is not worth a look
  const StaticSolver asked = settings.solver.static_solver;
  std::string why =
      why_not_newton(prepared.body, stepping_of(settings.solver, prepared.steps.step));
  steps.cost = relaxation_cost(prepared.body, steps.residual);
  if (why.empty() && asked != relaxation && (asked == newton || steps.cost.relaxation > quick))
    steps.cost = with_factor(steps.cost, prepared.body);
  if (why.empty() && steps.cost.nonzeros > max_factor)
    why = "the factor of Newton's method has over " + three_digits(max_factor) + " nonzeros";
  if (asked == newton && !why.empty())
    throw bad_input(settings.place("solver.static_solver"), why,
                    "set solver.static_solver to auto or relaxation");
  const bool pays = clearly * steps.cost.newton < steps.cost.relaxation;
  steps.solver =
      why.empty() && (asked == newton || (asked == automatic && pays)) ? newton : relaxation;
}

}  // namespace

LoadSteps load_steps_of(const Settings& settings, const Prepared& prepared) {
  // Slow beside waves, which would strain the body more than its load does.
  constexpr double carried_in_radii = 0.02, crossings = 4;
  const double r = prepared.body.material.pair.r;
  const FrameTimes& frames = prepared.frames;
  LoadSteps steps;
  steps.interval = frames.interval;
  steps.last = frames.before(frames.count) / frames.interval;
  steps.count = frames.count + 1;
  steps.max_iterations = settings.solver.iterations;
  const bool single = settings.solver.precision == Precision::binary32;
  steps.residual = settings.solver.residual.value_or(single ? 1e-2 : 1e-6);
  steps.acceptable = settings.solver.residual ? 0 : 1e-4;
  choose_static_solver(settings, prepared, steps);
  const double crossing = crossings * crossing_time(prepared.body) / prepared.steps.step;
  steps.min_ramp = static_cast<int>(std::clamp(std::ceil(crossing), 1.0, 1e8));
  for (const double speed : prepared.bone_speeds) {
    const int frame = static_cast<int>(steps.ramp.size());
    const bool loads = changes(prepared.body, frames.at(frame), frames.at(frame + 1));
    const double carried = speed * frames.before(frame + 1) / (carried_in_radii * r);
    const double ramp = carried > 0 || loads ? std::max(carried, crossing) : 1;
    steps.ramp.push_back(static_cast<int>(std::clamp(std::ceil(ramp), 1.0, 1e8)));
  }
  return steps;
}

double farthest_carried(const Prepared& prepared) {
  double farthest = 0;
  const std::vector<double>& speeds = prepared.bone_speeds;
  for (std::size_t i = 0; i < speeds.size(); ++i)
    farthest = std::max(farthest, speeds[i] / prepared.plan.parts(static_cast<int>(i)));
  return farthest * prepared.steps.step / prepared.body.material.pair.r;
}

namespace {

using kernel::InstructionSet;

// Measured with a bent body of 1e5 particles, whole steps, on a server core of about 2.5 GHz.
// Vectors of half the width do not take twice as long: loads and list construction stay the same.
// Without fused multiply-add instructions each one is a function call.
struct Speed {
  InstructionSet set;
  double in_double, in_single;  // particle-steps per second
};
constexpr Speed speeds_with_lists[] = {{InstructionSet::avx512, 35e6, 75e6},
                                       {InstructionSet::avx2, 23e6, 50e6},
                                       {InstructionSet::plain, 0.8e6, 1.3e6}};
// Whatever the instruction set: cells are sorted again, and pairs processed one by one.
constexpr double speed_with_cells = 2e6;

}  // namespace

StepperChoice stepper_choice(const SolverSettings& solver) {
  StepperChoice choice{solver.neighbor_search, solver.precision};
  if (choice.search == NeighborSearch::cells) {
    choice.precision = Precision::binary64;
    choice.instructions = InstructionSet::plain;
  }
  return choice;
}

const char* name_of(NeighborSearch search) {
  return search == NeighborSearch::lists ? "lists" : "cells";
}

const char* name_of(Precision precision) {
  return precision == Precision::binary64 ? "double" : "single";
}

double usual_speed(const StepperChoice& choice) {
  if (choice.search == NeighborSearch::cells) return speed_with_cells;
  for (const Speed& speed : speeds_with_lists)
    if (speed.set == choice.instructions)
      return choice.precision == Precision::binary64 ? speed.in_double : speed.in_single;
  return speed_with_cells;
}

}  // namespace sinew
