// SPDX-License-Identifier: GPL-3.0-or-later
// Materials that know their neighbors at rest: whole steps with lists and with cells.
#include <numeric>

#include <sinew/core/error.h>

#include "support/both_steppers.h"

namespace sinew::steppers_of_solids_test {

using namespace both_steppers;

/// One branch relaxes in each step, one in some.
void relax(MaterialOptions& material) {
  material.relaxation_shares = {0.3, 0.2};
  material.relaxation_times = {0.002, 1};
}

/// The moving scene with every material that knows its neighbors at rest.
std::vector<std::pair<std::string, Settings>> solids() {
  std::vector<std::pair<std::string, Settings>> solids;
  const auto add = [&](const std::string& name, auto&& change) {
    Settings settings = moving_scene();
    settings.material.model = MaterialModel::bonded;
    change(settings.material);
    solids.emplace_back(name, settings);
  };
  add("bonded", [](MaterialOptions&) {});
  add("undamped", [](MaterialOptions& material) { material.damping = 0; });
  add("initial_neighbors", [](MaterialOptions& material) {
    material.model = MaterialModel::paper;
    material.cohesion = Cohesion::initial_neighbors;
  });
  add("bonded_volume", [](MaterialOptions& material) {
    material.model = MaterialModel::bonded_volume;
    material.poisson_ratio = 0.45;
  });
  add("breaking", [](MaterialOptions& material) { material.breaking_strain = 0.01; });
  add("breaking volumes", [](MaterialOptions& material) {
    material.model = MaterialModel::bonded_volume;
    material.breaking_strain = 0.01;
  });
  add("yielding", [](MaterialOptions& material) {
    material.yield_strain = 0.01;
    material.creep_rate = 100;
  });
  add("breaking and yielding", [](MaterialOptions& material) {
    material.yield_strain = 0.01;
    material.creep_rate = 100;
    material.breaking_strain = 0.012;
  });
  add("relaxing", [](MaterialOptions& material) { relax(material); });
  add("relaxing, breaking and yielding volumes", [](MaterialOptions& material) {
    relax(material);
    material.model = MaterialModel::bonded_volume;
    material.yield_strain = 0.01;
    material.creep_rate = 100;
    material.breaking_strain = 0.012;
  });
  add("breaking and yielding parts of other volumes", [](MaterialOptions& material) {
    material.model = MaterialModel::bonded_volume;
    material.poisson_ratio = 0.3;
    material.breaking_strain = 0.05;
    material.creep_rate = 100;
  });
  LocalMaterialSettings stiff{"stiff", 3e4, 0.45, 3000, 0.012, {}},
      soft{"soft", 5e3, {}, 700, {}, 0.01};
  stiff.part.region.low = Vec3(-1, -1, 0.02), stiff.part.region.high = Vec3(1, 1, 1);
  soft.part.region.low = Vec3(-1, -1, -1), soft.part.region.high = Vec3(0, 1, 1);
  solids.back().second.materials = {stiff, soft};
  return solids;
}

int broken_bonds(const Simulation& simulation) {
  const auto broken = simulation.broken_bonds();
  return std::accumulate(broken.begin(), broken.end(), 0);
}

/// The bonds of both are whole and broken alike, and have crept alike.
void expect_same_bonds(const Both& both, const Points& rest) {
  const NeighborLists nearest = neighbors_within(rest, rest_neighbor_range(r));
  const NeighborLists second;
  const auto lists = both.lists.rest_of_bonds(nearest, second);
  const auto cells = both.cells.rest_of_bonds(nearest, second);
  for (std::size_t e = 0; e < nearest.neighbor.size(); ++e)
    EXPECT_NEAR(lists[e], cells[e], 1e-9 * r);
}

TEST(SteppersOfSolids, TakeTheSameSteps) {
  for (const auto& [name, settings] : solids())
    for (const Integrator integrator : integrators) {
      SCOPED_TRACE(name);
      Settings chosen = settings;
      chosen.solver.integrator = integrator;
      if (chosen.material.damping == 0 && integrator == Integrator::explicit_euler) continue;
      expect_same_steps(chosen);
    }
}

TEST(SteppersOfSolids, TakeTheSameStepsOfADisorderedBody) {
  for (const auto& [name, settings] : solids()) {
    SCOPED_TRACE(name);
    const Points rest = test::fcc_box(7, 7, 25, r);
    const Body body = test::make_body(settings, rest);
    Both both(settings, rest, test::shaken(rest, body.material, 0.8 * r, 0.1),
              test::step_of(settings, body, 0.1));
    for (const int steps : {1, 10}) {
      both.step_until(steps);
      expect_same(both, 1e-12);
      EXPECT_EQ(both.lists.broken_bonds(), both.cells.broken_bonds());
    }
  }
}

/// Where each bond has a length and a stiffness of its own, and any number of neighbors.
TEST(SteppersOfSolids, TakeTheSameStepsOfABodyThatIsNoLattice) {
  for (const auto& [name, settings] : solids()) {
    SCOPED_TRACE(name);
    const Material material = test::material_of(settings);
    const Points rest =
        positions_of(test::shaken(test::fcc_box(7, 7, 25, r), material, 0.2 * r, 0));
    const Body body = test::make_body(settings, rest);
    EXPECT_EQ(body.factors.particle.size(), material.bond.second > 0 ? rest.size() : 0);
    Both both(settings, rest, test::shaken(rest, material, 0.02 * r, 0.05),
              test::step_of(settings, body));
    both.step_until(50);
    expect_same(both, 1e-11);
    expect_same_bonds(both, rest);
  }
}

TEST(SteppersOfSolids, BreakTheSameBonds) {
  for (const auto& [name, settings] : solids()) {
    if (!settings.material.breaking_strain) continue;
    SCOPED_TRACE(name);
    const Points rest = test::fcc_box(7, 7, 25, r);
    const Body body = test::make_body(settings, rest);
    Both both(settings, rest, test::shaken(rest, body.material, 0.02 * r, 0.05),
              test::step_of(settings, body));
    both.step_until(200);
    EXPECT_GT(broken_bonds(both.cells), 20);
    EXPECT_EQ(both.lists.broken_bonds(), both.cells.broken_bonds());
    expect_same_bonds(both, rest);
    expect_same_energies(both.lists.energies(), both.cells.energies(), 1e-9);
  }
}

/// Lists look for flow only where it may have begun; cells look everywhere, in every step.
TEST(SteppersOfSolids, FlowWhereAndWhenItBegins) {
  Settings settings = test::box_scene(25);
  settings.material.model = MaterialModel::bonded;
  settings.material.yield_strain = 0.01;
  settings.tracks = {test::track("upper", {test::bend_key(0.05, 0), test::bend_key(0.35, 20)})};
  const Points rest = test::fcc_box(7, 7, 25, r);
  const Body body = test::make_body(settings, rest);
  Both both(settings, rest, particles_at(rest, r, body.material.mass),
            test::step_of(settings, body));
  both.step_until(static_cast<std::int64_t>(0.4 / both.step));
  expect_same(both, 1e-9);
  expect_same_bonds(both, rest);
  int flowed = 0;
  const auto lengths = both.lists.rest_of_bonds(neighbors_within(rest, rest_neighbor_range(r)), {});
  for (const double length : lengths) flowed += std::abs(length - 2 * r) > 1e-3 * r;
  EXPECT_GT(flowed, 100);
  EXPECT_LT(2 * flowed, static_cast<int>(lengths.size()));
}

TEST(SteppersOfSolids, TakeTheSameStepsInAnyOrderAndPacking) {
  for (const auto& [name, settings] : solids()) {
    SCOPED_TRACE(name);
    const Points rest = test::hcp_ball(7, r);
    const Body body = test::make_body(settings, rest);
    std::vector<std::size_t> order(rest.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::shuffle(order.begin(), order.end(), std::mt19937(3));
    Both both(settings, rest,
              test::reordered(test::shaken(rest, body.material, 0.02 * r, 0.05), order),
              test::step_of(settings, body));
    both.step_until(50);
    expect_same(both, 1e-11);
    expect_same_bonds(both, rest);
  }
}

TEST(SteppersOfSolids, SeparateCoincidentParticlesAlike) {
  for (const auto& [name, settings] : solids()) {
    SCOPED_TRACE(name);
    const Points rest = test::fcc_box(5, 5, 25, r);
    const Body body = test::make_body(settings, rest);
    Particles particles = particles_at(rest, r, body.material.mass);
    for (std::size_t i = 1; i < rest.size(); i += 4)
      particles.set_position(i, particles.position(i - 1));
    Both both(settings, rest, particles, test::step_of(settings, body, 0.05));
    expect_same(both, 1e-12);
    both.step_until(5);
    expect_same(both, 1e-12);
  }
}

TEST(SteppersOfSolids, AreCloseInSinglePrecision) {
  for (const auto& [name, settings] : solids()) {
    if (settings.material.breaking_strain) continue;  // rounding decides what breaks first
    SCOPED_TRACE(name);
    const Points rest = test::fcc_box(7, 7, 25, r);
    const Body body = test::make_body(settings, rest);
    const double step = test::step_of(settings, body);
    const Particles start = test::shaken(rest, body.material, 0.02 * r, 0.05);
    Simulation floats =
        test::simulation_from(test::in(Precision::binary32, settings), rest, start, step);
    Simulation cells = test::simulation_from(test::with_cells(settings), rest, start, step);
    while (cells.steps() < 100) floats.step(), cells.step();
    EXPECT_LT(test::largest_distance(floats.particles(), cells.particles()), 1e-4 * r);
    expect_same_energies(floats.energies(), cells.energies(), 1e-4);
  }
}

TEST(SteppersOfSolids, KeepTheirLedgersWhenABondedPairMeetsInAPoint) {
  for (const auto& [name, settings] : solids()) {
    SCOPED_TRACE(name);
    const Points rest = test::fcc_box(5, 5, 25, r);
    const Body body = test::make_body(settings, rest);
    Particles particles = particles_at(rest, r, body.material.mass);
    std::size_t nearest = 1;
    for (std::size_t i = 1; i < rest.size(); ++i)
      if ((rest[i] - rest[0]).norm() < (rest[nearest] - rest[0]).norm()) nearest = i;
    particles.set_position(nearest, particles.position(0));
    Both both(settings, rest, particles, test::step_of(settings, body, 0.05));
    both.step_until(5);
    expect_same(both, 1e-11);
    EXPECT_TRUE(std::isfinite(both.lists.energies().dissipation));
  }
}

TEST(SteppersOfSolids, OfAnotherMassThanTheMaterialsAreAlike) {
  for (const auto& [name, settings] : solids()) {
    SCOPED_TRACE(name);
    const Points rest = test::fcc_box(5, 5, 25, r);
    const Body body = test::make_body(settings, rest);
    Particles particles = test::shaken(rest, body.material, 0.02 * r, 0.05);
    particles.mass *= 4;
    Both both(settings, rest, particles, test::step_of(settings, body, 0.3));
    both.step_until(20);
    expect_same(both, 1e-11);
  }
}

TEST(SteppersOfSolids, GoOnAlikeAfterAStepThatFailed) {
  Settings settings = test::unbound(moving_scene());
  settings.material.model = MaterialModel::bonded;
  settings.material.breaking_strain = 0.05;
  const Points rest = test::fcc_box(5, 5, 9, r);
  const Body body = test::make_body(settings, rest);
  Particles particles = particles_at(rest, r, body.material.mass);
  particles.set_position(0, particles.position(0) - Vec3(0.3 * r, 0.3 * r, 0));
  particles.set_velocity(rest.size() - 1, Vec3(0, 0, 1e3));  // fails
  Both both(settings, rest, particles, test::step_of(settings, body, 0.3));
  EXPECT_THROW(both.lists.step(), Error);
  EXPECT_THROW(both.cells.step(), Error);
  EXPECT_GT(broken_bonds(both.cells), 0);
  EXPECT_EQ(both.lists.broken_bonds(), both.cells.broken_bonds());
  expect_same(both, 1e-11);
}

}  // namespace sinew::steppers_of_solids_test
