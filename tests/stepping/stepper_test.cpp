// SPDX-License-Identifier: GPL-3.0-or-later
// The seam between a simulation and its stepper: a stepper of one's own, batches of steps, and what
// may change between two of them.
#include <sinew/stepping/stepper.h>

#include <gtest/gtest.h>

#include <sinew/body/step_plan.h>
#include <sinew/rig/motion.h>
#include <sinew/stepping/equilibrium.h>
#include <sinew/stepping/simulation.h>

#include "support/all_steppers.h"
#include "support/expect_error.h"

namespace sinew::stepper_test {

constexpr double r = 0.01;

/// Particles that fly freely under gravity.
class Flight final : public Stepper {
 public:
  Flight(const Stepping& stepping, const Particles& particles)
      : step_(stepping.step), gravity_(stepping.gravity), now_(particles) {}

  void advance(std::span<const TimedPose> begins, std::vector<StepSums>& sums) override {
    ++batches;
    for (std::size_t n = 0; n < begins.size(); ++n, sums.emplace_back())
      for (std::size_t i = 0; i < now_.size(); ++i) {
        now_.set_velocity(i, now_.velocity(i) + step_ * gravity_);
        now_.set_position(i, now_.position(i) + step_ * now_.velocity(i));
      }
  }
  void set_step(double step) override { step_ = step; }
  Balance evaluate(const TimedPose&, Forces& forces) override {
    forces.pair = forces.damping = forces.bone = Points(now_.size(), Vec3::Zero());
    return {};
  }
  void read(const TimedPose&, Particles& particles) override { particles = now_; }
  void save(SimulationState& state) override {
    state.moving = MovingInDouble{{now_.x, now_.y, now_.z}, {now_.u, now_.v, now_.w}};
  }
  void restore(const SimulationState& state) override {
    const auto& moving = std::get<MovingInDouble>(state.moving);
    now_.x = moving.x[0], now_.y = moving.x[1], now_.z = moving.x[2];
    now_.u = moving.v[0], now_.v = moving.v[1], now_.w = moving.v[2];
  }

  static inline int batches = 0;

 private:
  double step_;
  Vec3 gravity_;
  Particles now_;
};

TEST(OwnStepper, IsDrivenSavedAndRestored) {
  const Settings settings = test::unbound(test::box_scene(9));
  const Points rest = test::fcc_box(5, 5, 9, r);
  const Body body = test::make_body(settings, rest);
  Stepping stepping;
  stepping.step = 1e-3;
  stepping.gravity = Vec3(0, 0, -10);
  Simulation simulation(body, motion_of(settings, body.skeleton),
                        test::particles_of(settings, rest), stepping,
                        [](auto, const Stepping& first, Particles& particles) {
                          return std::make_unique<Flight>(first, particles);
                        });
  Flight::batches = 0;
  simulation.advance(100);
  EXPECT_LT(Flight::batches, 10) << "many steps are one call";
  const auto fallen = [&] { return rest[0].z() - simulation.particles().position(0).z(); };
  EXPECT_NEAR(fallen(), 10 * 1e-6 * 100 * 101 / 2, 1e-12);
  EXPECT_NEAR(simulation.energies().kinetic,
              total_mass(body, body.material.mass) * 1.005 * 1.005 / 2, 1e-9)
      << "at the moment of the positions";
  const SimulationState state = simulation.save();
  simulation.advance(50);
  simulation.restore(state);
  simulation.advance(50);
  EXPECT_NEAR(fallen(), 10 * 1e-6 * 150 * 151 / 2, 1e-12);
  EXPECT_EQ(simulation.steps(), 150);
  test::expect_bad_input([&] { simulation.relax({}); }, {"equilibria exclude each other"});
  test::expect_bad_input([&] { simulation.enable_dynamic_groups({}); },
                         {"groups of particles exclude each other"});
}

Settings bending(MaterialModel model = MaterialModel::bonded) {
  Settings settings = test::box_scene(25);
  settings.material.model = model;
  settings.tracks = {test::track("upper", {test::bend_key(0, 0), test::bend_key(0.3, 40)})};
  return settings;
}

Points bar() { return test::fcc_box(7, 7, 25, r); }

void expect_same_bits(Simulation& a, Simulation& b) {
  EXPECT_EQ(a.time(), b.time());
  for (const auto axis : {&Particles::x, &Particles::y, &Particles::z, &Particles::u})
    EXPECT_EQ(a.particles().*axis, b.particles().*axis);
  EXPECT_EQ(a.energies().work_of_bones, b.energies().work_of_bones);
  EXPECT_EQ(a.energies().dissipation, b.energies().dissipation);
}

TEST(Batches, AreTheSameStepsAsOneByOne) {
  for (const Settings& settings :
       {bending(), bending(MaterialModel::paper), test::in(Precision::binary32, bending()),
        test::with_cells(bending())}) {
    Simulation once = test::make_simulation(settings, bar());
    Simulation one_by_one = test::make_simulation(settings, bar());
    once.advance(150);
    for (int n = 0; n < 150; ++n) one_by_one.step();
    expect_same_bits(once, one_by_one);
  }
}

/// The forces that are told after a step are those of its end, where the next step is shorter.
TEST(Batches, OfStepsOfOtherSizesLeaveNoOldForces) {
  Simulation simulation = test::make_simulation(bending(), bar());
  const double step = simulation.save().even.step;
  ASSERT_GT(step, 0);
  simulation.follow(StepPlan(step, 1, {1, 1, 2, 2, 1, 1}));
  for (int n = 0; n < 8; ++n) {
    simulation.step();
    const Vec3 found = simulation.forces().total(5);
    simulation.restore(simulation.save());
    EXPECT_EQ(simulation.forces().total(5), found) << "after step " << n;
  }
}

TEST(Between, StepsMayBecomeShorterAndTimeGoesOn) {
  Settings settings = test::unbound(test::box_scene(9));
  settings.solver.gravity = Vec3(0, 0, -9.81);
  const Points rest = test::fcc_box(5, 5, 9, r);
  Simulation simulation =
      test::simulation_from(settings, rest, test::particles_of(settings, rest), 1e-3);
  simulation.advance(100);
  simulation.set_time_step(0.5e-3);
  simulation.advance(100);
  EXPECT_NEAR(simulation.time(), 0.15, 1e-15);
  // Velocities are half a step behind: the fall is that of the middle of each step.
  const double fallen = rest[0].z() - simulation.particles().position(0).z();
  EXPECT_NEAR(fallen, 9.81 * 0.15 * 0.15 / 2, 9.81 * 0.15 * 0.6e-3);
  const SimulationState state = simulation.save();
  simulation.set_time_step(0.25e-3);
  simulation.advance(3);
  simulation.restore(state);
  EXPECT_EQ(simulation.time(), state.even.since + 100 * 0.5e-3);
  simulation.advance(1);
  EXPECT_NEAR(simulation.time(), 0.1505, 1e-15) << "of the size that it had then";
  for (const double bad : {0.0, -1.0, std::nan("")})
    test::expect_bad_input([&] { simulation.set_time_step(bad); }, {"a time step of"});
}

/// A state saved between the new step and the first of its size continues as if it had not been.
TEST(Between, AStepThatIsNewIsKeptInAState) {
  Simulation once = test::make_simulation(bending(), bar());
  Simulation saved = test::make_simulation(bending(), bar());
  for (Simulation* one : {&once, &saved}) {
    one->advance(40);
    one->set_time_step(one->save().even.step / 3);
  }
  saved.restore(saved.save());
  once.advance(40);
  saved.advance(40);
  expect_same_bits(once, saved);
}

/// A body that goes on with another material feels its forces at once.
TEST(Between, TheMaterialMayChange) {
  for (const auto& [settings, tolerance] :
       {std::pair{bending(), 1e-12}, std::pair{bending(MaterialModel::paper), 1e-12},
        std::pair{test::in(Precision::binary32, bending()), 1e-4},
        std::pair{test::with_cells(bending()), 1e-12}}) {
    Simulation simulation = test::make_simulation(settings, bar());
    simulation.advance(100);
    Simulation same = test::make_simulation(settings, bar());
    same.advance(50);
    same.set_material(Material(same.body().material));
    same.advance(50);
    expect_same_bits(same, simulation);
    const Forces before = simulation.forces();
    Material stiff = simulation.body().material;
    for (double* one : {&stiff.pair.k1, &stiff.pair.k2, &stiff.bond.stiffness, &stiff.bond.second})
      *one *= 2;
    simulation.set_material(stiff);
    EXPECT_EQ(simulation.steps(), 100);
    double most = 0, scale = 0;
    for (std::size_t i = 0; i < before.pair.size(); ++i) {
      most = std::max(most, (simulation.forces().pair[i] - 2 * before.pair[i]).norm());
      scale = std::max(scale, before.pair[i].norm());
    }
    EXPECT_LE(most, tolerance * scale);
    simulation.advance(20);
  }
  Simulation simulation = test::make_simulation(bending(), bar());
  Material other = simulation.body().material;
  other.mass *= 2;
  test::expect_bad_input([&] { simulation.set_material(other); }, {"other particles"});
  for (const double bad : {std::nan(""), 1e200, -1.0}) {
    other = simulation.body().material;
    other.pair.k1 = bad;
    test::expect_bad_input([&] { simulation.set_material(other); }, {"a constant of"});
  }
  other = simulation.body().material;
  simulation.relax({.interval = 0.1});
  test::expect_bad_input([&] { simulation.set_material(other); }, {"brought to rest"});
  test::expect_bad_input([&] { simulation.set_time_step(1e-4); }, {"follow a plan"});
}

/// A motion to which keys are added goes on as if they had been known.
TEST(Between, AMotionMayGrow) {
  Settings known = bending(), grown = bending();
  for (Settings* settings : {&known, &grown})
    settings->tracks[0].interpolation = Interpolation::linear;
  known.tracks[0].keys.push_back(test::bend_key(0.6, -20));
  Simulation whole = test::make_simulation(known, bar()),
             live = test::make_simulation(grown, bar());
  while (live.time() < 0.25) live.step();
  const SimulationState state = live.save();
  live.advance(10);
  live.play(motion_of(known, live.body().skeleton));
  live.restore(state);  // of the motion before
  while (live.time() < 0.4) live.step();
  while (whole.time() < 0.4) whole.step();
  expect_same_bits(live, whole);
}

}  // namespace sinew::stepper_test
