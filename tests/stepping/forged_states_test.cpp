// SPDX-License-Identifier: GPL-3.0-or-later
// States from elsewhere, whose checksums are right: what cannot be of this body is refused.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include <sinew/scene/prepare.h>
#include <sinew/scene/rig.h>

#include "support/all_steppers.h"
#include "support/expect_error.h"

namespace sinew::forged_states_test {
namespace {

Simulation begin(
    Precision precision, const std::function<void(Body&)>& change = [](Body&) {}) {
  constexpr int planes = 17;
  constexpr double r = 0.01;
  const Settings settings = test::in(precision, test::box_scene(planes));
  const Points rest = test::fcc_box(7, 7, planes, r);
  Body body = test::make_body(settings, rest);
  change(body);
  const Particles particles = test::shaken(rest, body.material, 0, 0);
  const double step = test::step_of(settings, body, 0.5);
  return {body, motion_of(settings, body.skeleton), particles, stepping_of(settings.solver, step)};
}

void expect_refused(Precision precision, const std::function<void(SimulationState&)>& forge,
                    const char* why) {
  SimulationState state = begin(precision).save();
  forge(state);
  test::expect_bad_input([&] { begin(precision).restore(state); }, {why});
}

TEST(ForgedStates, HaveTheUnitsOfTheBody) {
  for (const Precision precision : test::precisions) {
    for (const double length : {0.0, 1e-242, 1e200, std::nan("")})
      expect_refused(
          precision, [&](auto& state) { state.fixed_point_units.length = length; }, "units");
    expect_refused(
        precision, [](auto& state) { state.fixed_point_units.box.max().x() = 1e50; }, "units");
    begin(precision).restore(begin(precision).save());
  }
}

TEST(ForgedStates, HaveNoParticleFarAway) {
  for (const double place : {1e300, -1e30, 1e12})
    expect_refused(
        Precision::binary64,
        [&](auto& state) { std::get<MovingInDouble>(state.moving).x[2][5] = place; }, "far away");
}

TEST(SavedStates, AreOfOneBody) {
  const SimulationState state = begin(Precision::binary64).save();
  const std::function<void(Body&)> changes[] = {
      [](Body& body) { body.rest[3].x() += 1e-9; },
      [](Body& body) { body.binding.influences[5].weight *= 0.5; },
      [](Body& body) { body.skeleton.bones[0].name += '2'; },
      [](Body& body) { body.skeleton.bones[1].rest.origin.z() += 1e-9; }};
  for (const auto& change : changes)
    test::expect_bad_input([&] { begin(Precision::binary64, change).restore(state); },
                           {"others", "restore one that the same scene has saved"});
  SimulationState from_file = state;
  from_file.body = 0;  // of a checkpoint, which knows its run
  begin(Precision::binary64, changes[0]).restore(from_file);
  begin(Precision::binary64).restore(state);
}

}  // namespace
}  // namespace sinew::forged_states_test
