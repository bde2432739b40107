// SPDX-License-Identifier: GPL-3.0-or-later
// Friction of a body on itself: contacts stick and slip as Coulomb's do, give no momentum, lose the
// energy that the ledger names, and are the same in all steppers, on any threads and when resumed.
#include <sinew/world/sliding_contacts.h>

#include <sinew/core/hash.h>
#include <sinew/core/parallel.h>
#include <sinew/material/laws.h>

#include "support/all_steppers.h"

namespace sinew::sliding_contacts_test {
namespace {

constexpr double r = 0.01;
constexpr int during = 10;  // steps: the blocks press on each other

Settings scene(double friction, MaterialModel model = MaterialModel::bonded) {
  Settings settings = test::unbound(test::box_scene(5));
  settings.material.model = model;
  if (model == MaterialModel::paper) settings.material.cohesion = Cohesion::initial_neighbors;
  settings.material.damping_form = DampingForm::central;
  settings.material.friction = friction;
  return settings;
}

/// Two blocks, far apart at rest, of which the upper one comes down on the lower one and slides.
struct Blocks {
  Settings settings;
  Body body;
  Particles particles;
  std::size_t lower;
  double of_limit = 0.3;

  explicit Blocks(const Settings& chosen) : settings(chosen) {
    Points rest = test::fcc_box(5, 5, 5, r), start = rest;
    lower = rest.size();
    const double top = rest.back().z() - rest.front().z();
    for (std::size_t i = 0; i < lower; ++i) {
      rest.push_back(rest[i] + Vec3(0, 0, top + 20 * r));
      start.push_back(start[i] + Vec3(0.3 * r, 0.2 * r, top + 1.9 * r));
    }
    body = test::make_body(settings, rest);
    particles = particles_at(start, r, body.material.mass);
    for (std::size_t i = lower; i < particles.size(); ++i)
      particles.set_velocity(i, {0.3, 0, -0.1});
  }

  Simulation begin(Precision precision = Precision::binary64,
                   NeighborSearch search = NeighborSearch::lists) const {
    Settings in = settings;
    in.solver.precision = precision;
    in.solver.neighbor_search = search;
    return Simulation(body, {}, particles,
                      stepping_of(in.solver, test::step_of(in, body, of_limit)));
  }

  Simulation after(int steps, Precision precision = Precision::binary64,
                   NeighborSearch search = NeighborSearch::lists) const {
    Simulation simulation = begin(precision, search);
    while (simulation.steps() < steps) simulation.step();
    return simulation;
  }

  double sliding_of(const Simulation& simulation) const {
    double sum = 0;
    for (std::size_t i = lower; i < particles.size(); ++i)
      sum += simulation.particles().velocity(i).x();
    return sum / static_cast<double>(particles.size() - lower);
  }
};

std::uint64_t hash_of(const Particles& particles) {
  Hash hash;
  for (const auto* axis : {&particles.x, &particles.y, &particles.z, &particles.u})
    hash.add(axis->data(), axis->size() * sizeof(double));
  return hash.value();
}

TEST(SlidingContacts, StickAndThenSlip) {
  Body body = Blocks(scene(0.5)).body;
  SlidingContacts sliding(body);
  const double k = body.material.pair.contact_stiffness();
  const double c = 0.25 * std::sqrt(k * body.material.mass), step = 1e-4, speed = 0.01;
  const double pressing = 2 * (k / 2 * speed * step * 20 + c * speed);  // slips after 20 steps
  const Touch touch{1, Vec3::UnitZ(), pressing, {speed, 0, 0.3}};
  for (int n = 1; n <= 30; ++n) {
    const Vec3 force = sliding.force(0, {{touch}}, step, true);
    const double stuck = k / 2 * speed * step * n + c * speed;
    EXPECT_NEAR(force.x(), -std::min(stuck, 0.5 * pressing), 1e-9 * pressing) << n;
    EXPECT_EQ(force.z(), 0);
  }
  const Touch back{1, Vec3::UnitZ(), pressing, {-speed, 0, 0}};
  EXPECT_LT(sliding.force(0, {{back}}, step, true).x(), 0);  // the spring is still stretched
  for (int n = 0; n < 600; ++n) sliding.force(0, {{back}}, step, true);
  EXPECT_NEAR(sliding.force(0, {{back}}, step, true).x(), 0.5 * pressing, 1e-9 * pressing);
}

TEST(SlidingContacts, ForgetWhatHasParted) {
  Body body = Blocks(scene(0.5)).body;
  SlidingContacts sliding(body);
  const Touch moving{1, Vec3::UnitZ(), 1e9, {0.01, 0, 0}}, still{1, Vec3::UnitZ(), 1e9, {0, 0, 0}};
  sliding.force(0, {{moving}}, 1e-3, true);
  EXPECT_LT(sliding.force(0, {{still}}, 1e-3, false).x(), 0);
  sliding.force(0, {}, 1e-3, true);
  EXPECT_EQ(sliding.force(0, {{still}}, 1e-3, false).x(), 0);
}

TEST(SlidingContacts, SlowTheBlockAndKeepItsMomentum) {
  for (const MaterialModel model :
       {MaterialModel::bonded, MaterialModel::bonded_volume, MaterialModel::paper}) {
    const Blocks smooth(scene(0, model)), rough(scene(0.6, model));
    Simulation with = rough.after(during);
    EXPECT_LT(rough.sliding_of(with), smooth.sliding_of(smooth.after(during)));
    Vec3 before = Vec3::Zero(), now = Vec3::Zero(), friction = Vec3::Zero();
    double acting = 0;
    for (std::size_t i = 0; i < rough.particles.size(); ++i) {
      before += rough.particles.velocity(i);
      now += with.particles().velocity(i);
      friction += with.forces().world[i];
      acting = std::max(acting, with.forces().world[i].norm());
    }
    EXPECT_LT((now - before).norm(), 1e-11 * before.norm());
    EXPECT_GT(acting, 0);
    EXPECT_LT(friction.norm(), 1e-12 * acting);
  }
}

/// The upper block, turned so that the lattices do not interlock, lies on the lower one, which is
/// held, under a weight that is tilted by 15 degrees. How far its mean moves between two moments
/// (s), in radii.
double slip_of_tilted(double friction, double from, double to) {
  Settings settings = scene(friction);
  settings.solver.gravity = Vec3(std::sin(radians(15)), 0, -std::cos(radians(15)));
  Blocks blocks(settings);
  World world;
  world.pins = pinned(blocks.body.rest, {{{BoxShape{{0, 0, 0}, {1, 1, 12 * r}}, 0}, no_bone}}, 1);
  EXPECT_EQ(world.pins.size(), blocks.lower);
  blocks.body.world = std::make_shared<const World>(world);
  const Mat3 turn = Eigen::AngleAxisd(0.5, Vec3::UnitZ()).toRotationMatrix();
  const double top = blocks.body.rest[blocks.lower - 1].z() - blocks.body.rest[0].z();
  const Vec3 middle = blocks.body.rest[blocks.lower / 2];
  for (std::size_t i = blocks.lower; i < blocks.particles.size(); ++i) {
    const Vec3 at = blocks.body.rest[i - blocks.lower];
    const Vec3 over = middle + turn * (at - middle);
    blocks.particles.set_position(i, {over.x(), over.y(), at.z() + top + 1.6 * r});
    blocks.particles.set_velocity(i, Vec3::Zero());
  }
  Simulation simulation = blocks.begin();
  const auto place = [&] {
    double sum = 0;
    for (std::size_t i = blocks.lower; i < blocks.particles.size(); ++i)
      sum += simulation.particles().position(i).x();
    return sum / static_cast<double>(blocks.lower);
  };
  while (simulation.time() < from) simulation.step();
  const double settled = place();
  while (simulation.time() < to) simulation.step();
  return (place() - settled) / r;
}

TEST(SlidingContacts, HoldABlockOnASlopeBelowTheirAngle) {
  EXPECT_GT(slip_of_tilted(0.05, 0.1, 0.5), 1.5);
  EXPECT_LT(std::abs(slip_of_tilted(0.5, 0.5, 2)), 0.3);  // it rocks where it stands
}

TEST(SlidingContacts, AreNeverMoreThanCoulombsForce) {
  const Blocks blocks(scene(0.6));
  Simulation simulation = blocks.after(during);
  const Particles& now = simulation.particles();
  int slipping = 0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    double pressing = 0;
    for (std::size_t j = 0; j < now.size(); ++j) {
      const double d = (now.position(i) - now.position(j)).norm();
      if (i != j && d < 2 * r && (i < blocks.lower) != (j < blocks.lower))
        pressing += law_of(blocks.body.material).force(blocks.body.material, d);
    }
    const double friction = simulation.forces().world[i].norm();
    EXPECT_LE(friction, 0.6 * pressing * (1 + 1e-9));
    slipping += friction > 0.5 * pressing && pressing > 0;
  }
  EXPECT_GT(slipping, 5);
}

TEST(SlidingContacts, LoseWhatTheLedgerSays) {
  Settings settings = scene(0.6);
  settings.material.damping = 0;
  Blocks blocks(settings);
  blocks.of_limit = 0.03;
  Simulation simulation = blocks.begin();
  const double begun = simulation.energies().stored();
  while (simulation.steps() < 2000) simulation.step();
  const Energies end = simulation.energies();
  EXPECT_GT(end.dissipation, 0.05 * end.kinetic);
  EXPECT_NEAR(end.stored() + end.dissipation, begun, 0.01 * end.dissipation);
}

TEST(SlidingContacts, KernelAsReference) {
  for (const MaterialModel model :
       {MaterialModel::bonded, MaterialModel::bonded_volume, MaterialModel::paper}) {
    const Blocks blocks(scene(0.6, model));
    Simulation reference = blocks.after(20, Precision::binary64, NeighborSearch::cells);
    Simulation doubles = blocks.after(20), floats = blocks.after(20, Precision::binary32);
    EXPECT_LT(test::largest_distance(doubles.particles(), reference.particles()), 1e-9 * r);
    EXPECT_LT(test::largest_distance(floats.particles(), reference.particles()), 1e-2 * r);
    EXPECT_NEAR(doubles.energies().dissipation, reference.energies().dissipation,
                1e-7 * reference.energies().dissipation);
  }
}

TEST(SlidingContacts, SameBitsOnThreadsAndWhenResumed) {
  for (const Precision precision : test::precisions)
    for (const NeighborSearch search : {NeighborSearch::lists, NeighborSearch::cells}) {
      if (search == NeighborSearch::cells && precision == Precision::binary32) continue;
      const Blocks blocks(scene(0.6));
      std::uint64_t whole = 0, resumed = 0;
      with_threads(1, [&] { whole = hash_of(blocks.after(120, precision, search).particles()); });
      with_threads(4, [&] {
        const SimulationState state = blocks.after(during, precision, search).save();
        EXPECT_FALSE(column_of<double>(state, "friction", "stretches").empty());
        Simulation second = blocks.begin(precision, search);
        second.restore(state);
        while (second.steps() < 120) second.step();
        resumed = hash_of(second.particles());
      });
      EXPECT_EQ(whole, resumed);
    }
}

TEST(SlidingContacts, StatesOfOtherBodiesAreRefused) {
  const Blocks blocks(scene(0.6));
  SimulationState state = blocks.after(during).save();
  auto pairs = column_of<std::int32_t>(state, "friction", "pairs");
  pairs[0] = 100'000;
  put_column(state, "friction", "pairs", pairs);
  Simulation simulation = blocks.begin();
  EXPECT_THROW(simulation.restore(state), Error);
}

}  // namespace
}  // namespace sinew::sliding_contacts_test
