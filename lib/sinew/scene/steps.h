// SPDX-License-Identifier: GPL-3.0-or-later
// The steps of a scene: how long they are, where fast bones need shorter ones, and which stepper
// makes them.
//
//     prepared.steps = steps_of(settings, prepared.body);
//     prepared.plan = plan_of(settings, prepared);
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <sinew/analysis/time_step.h>
#include <sinew/body/step_plan.h>
#include <sinew/kernel/instruction_set.h>
#include <sinew/settings/settings.h>
#include <sinew/stepping/equilibrium.h>

namespace sinew {

struct Prepared;

/// The moments of frames: one every `interval` from 0 on, and the last at `end`.
struct FrameTimes {
  double interval = 0, end = 0;  ///< s
  int count = 0;                 ///< after that at 0

  double at(int frame) const { return std::min(frame * interval, end); }
  /// Returns the time since the frame before, s.
  double before(int frame) const { return is_cut(frame) ? end - at(frame - 1) : interval; }
  /// Whether it comes sooner than a whole interval after the one before.
  bool is_cut(int frame) const {
    return frame == count && frame * interval - end > negligible * interval;
  }

  static constexpr double negligible = 1e-6;  ///< fraction of an interval
};
/// Throws bad input, with the scene's line, for over a million.
FrameTimes frame_times(const Settings& settings);

/// The settings of section solver for stepping, with the chosen step, s.
Stepping stepping_of(const SolverSettings& solver, double step);
StepChoice choose_step(const SolverSettings& solver, double limit, double interval);

/// Whether explicit Euler lets something grow, as it is not damped: its step then goes by the
/// duration.
bool grows(const Settings& settings, const Body& body);

/// For a body. Throws bad input, with the scene's line, where no step is stable.
StepChoice steps_of(const Settings& settings, const Body& body);

/// An upper bound of the speed at which bones and supports carry any particle, m/s: from each frame
/// to the next. Takes its time where frames and bones are many: once, into Prepared::bone_speeds.
std::vector<double> bone_speeds(const Prepared& prepared);

/// With time_step: auto, the steps of each interval are divided until bones carry no particle
/// farther in one than max_carried radii; otherwise all are even.
StepPlan plan_of(const Settings& settings, const Prepared& prepared);
inline constexpr double max_carried = 0.2;

/// An upper bound of how far bones carry any particle in one step, in radii.
double farthest_carried(const Prepared& prepared);

/// Plans a scene of the static method: its frames are moments at which the body is at rest.
LoadSteps load_steps_of(const Settings& settings, const Prepared& prepared);

/// An upper bound of the rate at which the scene's bones, supports, obstacles and loads strain the
/// body, 1/s: their fastest turn, and their largest speed over the body's smallest width; loads
/// give the speed that they reach over that width. Reads frames, bone_speeds and the body.
double strain_rate(const Prepared& prepared);

/// The rate of material.creep_rate, 1/s; auto: so fast that at strain_rate() the stress of a bar
/// that is pulled exceeds the yield stress by 2 %, but no faster than half of what exceeds it in a
/// step; and at once in the static method.
double creep_rate_of(const Prepared& prepared);
/// Fraction of the yield stress by which that stress exceeds it; 0 where the rate is not automatic.
double stress_above_yield(const Prepared& prepared);

// The stepper that a run uses.

struct StepperChoice {
  NeighborSearch search = NeighborSearch::lists;
  Precision precision = Precision::binary64;
  kernel::InstructionSet instructions = kernel::best_instruction_set();
};

/// The cell stepper has one precision, double, and no vector instructions.
StepperChoice stepper_choice(const SolverSettings& solver);

/// Spells them as the scene's keys do.
const char* name_of(NeighborSearch search);
const char* name_of(Precision precision);

/// Typical particle-steps per second on one core.
double usual_speed(const StepperChoice& choice);

}  // namespace sinew
