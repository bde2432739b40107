// SPDX-License-Identifier: GPL-3.0-or-later
// What a Simulation consists of, for it and for GuardedSteps.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <sinew/body/ledger.h>
#include <sinew/body/step_plan.h>
#include <sinew/stepping/detail/dynamic_grouping.h>
#include <sinew/stepping/detail/load_increments.h>
#include <sinew/stepping/simulation.h>
#include <sinew/stepping/stepper.h>

namespace sinew {

struct Simulation::Impl {
  Impl(Body given, Motion given_motion, Particles given_particles, const Stepping& first,
       MakeStepper with)
      : body(std::make_shared<Body>(std::move(given))),
        motion(std::make_shared<const Motion>(std::move(given_motion))),
        cursor(body->skeleton, *motion),
        stepping(first),
        plan(first.step),
        unit_of_time(first.step),
        make(std::move(with)),
        stepper(make(body, first, given_particles)),
        ledger(first.step),
        world_ledger(first.step),
        particles(std::move(given_particles)) {}

  std::shared_ptr<Body> body;  ///< whose grouping may change
  std::uint64_t checksum = hash_of(*body).value();
  std::shared_ptr<const Motion> motion;
  PoseCursor cursor;
  Stepping stepping;  ///< with the step made last
  StepPlan plan;
  std::int64_t plan_from = 0;  ///< the step at which the plan begins, and its time, s
  double plan_since = 0;
  double unit_of_time;  ///< time unit of velocities in single precision, s
  std::int64_t steps = 0;
  MakeStepper make;
  std::unique_ptr<Stepper> stepper;
  std::unique_ptr<LoadIncrements> increments;  ///< increments of what is brought to rest
  std::unique_ptr<DynamicGrouping> dynamic;
  EnergyLedger ledger, world_ledger;
  double held_at_start = 0;  ///< kinetic energy of what pins hold, J
  LimitedSpeeds limited;

  std::vector<Offender> offenders;
  std::vector<TimedPose> moments;  ///< memory of those of the steps
  std::vector<StepSums> sums;      ///< the same
  Particles particles;  ///< particles as read last; radius, mass and ids are always valid
  bool read = false;    ///< whether they are those of the present moment
  Forces forces;
  Balance balance;
  bool evaluated = false;
};

}  // namespace sinew
