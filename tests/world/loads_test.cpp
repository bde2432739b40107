// SPDX-License-Identifier: GPL-3.0-or-later
// Forces and pressures on parts of a body, and points that follow particles.
#include <sinew/world/loads.h>

#include <functional>
#include <numbers>
#include <random>

#include <sinew/core/parallel.h>
#include <sinew/mesh/refine.h>

#include "support/expect_error.h"
#include "support/machine.h"

namespace sinew::loads_test {

using namespace machine;

/// The surface of an upright box, refined to sides of at most 2r.
Triangles box_surface(const Vec3& low, const Vec3& high) {
  Triangles box;
  for (int k = 0; k < 8; ++k)
    box.points.emplace_back((k & 1) ? high.x() : low.x(), (k & 2) ? high.y() : low.y(),
                            (k & 4) ? high.z() : low.z());
  const int quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                           {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& [a, b, c, d] : quads) {
    box.faces.push_back({a, b, c});
    box.faces.push_back({a, c, d});
  }
  return refined(box, 2 * r);
}

Triangles around(const Points& rest) {
  const Box box = bounds(rest);
  return box_surface(box.min() - Vec3::Constant(0.7 * r), box.max() + Vec3::Constant(0.7 * r));
}

TEST(FollowingPoints, FollowAffineMotionsExactly) {
  const Points rest = test::fcc_box(7, 7, 15, r);
  const Triangles skin = around(rest);
  const FollowingPoints points = following(skin.points, rest, r);
  std::mt19937 random(3);
  const Mat3 F = Mat3::Identity() + test::random_matrix(random);
  const Points now = points.at(test::affine(rest, F, {1, 2, 3}));
  const Points expected = test::affine(skin.points, F, {1, 2, 3});
  for (std::size_t k = 0; k < now.size(); ++k)
    ASSERT_LT((now[k] - expected[k]).norm(), 1e-11 * r) << k;
}

TEST(FollowingPoints, FollowFarFromTheOriginAsAtIt) {
  const Points rest = test::fcc_box(7, 7, 15, r);
  const Triangles skin = around(rest);
  const Vec3 far(std::ldexp(0.25, 24), 0, 0);  // 1e7 sizes, where places are 1e-9 m apart
  const auto there = [&](const Points& points) {
    return test::affine(points, Mat3::Identity(), far);
  };
  const FollowingPoints points = following(there(skin.points), there(rest), r);
  const Mat3 F = Vec3(1.1, 0.9, 1.05).asDiagonal();
  const Points now = points.at(there(test::affine(rest, F)));
  for (std::size_t k = 0; k < now.size(); ++k)
    ASSERT_LT((now[k] - far - F * skin.points[k]).norm(), 1e-8) << k;
}

TEST(FollowingPoints, OfASheetAndOfFewParticlesFollowTheirFeet) {
  Points sheet;
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j < 9; ++j) sheet.emplace_back(2 * r * i, 2 * r * j, 0);
  const Vec3 above(7 * r, 9 * r, 3 * r);
  EXPECT_LT((following({above}, sheet, r).at(sheet)[0] - Vec3(7 * r, 9 * r, 0)).norm(), 1e-9 * r);
  const Points one = {{0.1, 0, 0}};
  EXPECT_LT((following({above}, one, r).at(one)[0] - one[0]).norm(), 1e-15);
  const Points far = {{0, 0, 0}, {5, 0, 0}};
  EXPECT_EQ(nearest_particles({{4, 0, 0}, {-90, 0, 0}}, far, r),
            (std::vector<std::uint32_t>{1, 0}));
  test::expect_bad_input([&] { following({above}, {}, r); }, {"no particles"});
}

Vec3 force_of(const Load& load, const LoadNow& now) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 0; k < load.particles.size(); ++k) sum += now.force(k);
  return sum;
}

/// Any deformation that is smooth over some particles.
Points deformed(const Points& rest) {
  Points now;
  for (const Vec3& p : rest)
    now.push_back(p + Vec3(0.01 * std::sin(20 * p.z()), 0.3 * p.x() * p.z(), 0.2 * p.y()));
  return now;
}

TEST(Loads, APressureOnAClosedBodySumsToZeroWithItsMoments) {
  const Points rest = test::fcc_box(7, 7, 15, r), now = deformed(rest);
  const Load load = pressure_load("press", around(rest), 2000, rest, r);
  LoadNow at(load);
  at.find(
      {0.5}, [&](std::size_t k) { return now[load.particles[k]]; }, false);
  Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
  double most = 0;
  for (std::size_t k = 0; k < load.particles.size(); ++k) {
    sum += at.force(k);
    moment += now[load.particles[k]].cross(at.force(k));
    most += at.force(k).norm();
  }
  EXPECT_GT(most, 1000 * 0.05);
  EXPECT_LT(sum.norm(), 1e-13 * most);
  EXPECT_LT(moment.norm(), 1e-13 * most);
}

TEST(Loads, TheWorkOfAPressureIsTheVolumeLost) {
  const Points rest = test::fcc_box(7, 7, 15, r), now = deformed(rest);
  Triangles skin = around(rest);
  const Load load = pressure_load("press", skin, 2000, rest, r);
  LoadNow at(load);
  at.find(
      {}, [&](std::size_t k) { return now[load.particles[k]]; }, false);
  const FollowingPoints points = following(skin.points, rest, r, followed_by_corners);
  std::mt19937 random(5);
  double power = 0;
  Points moved[2] = {now, now};
  const double by = 1e-6 * r;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const Vec3 step = test::random_vector(random);
    moved[0][i] -= by * step;
    moved[1][i] += by * step;
    for (std::size_t k = 0; k < load.particles.size(); ++k)
      if (load.particles[k] == i) power += at.force(k).dot(step);
  }
  double volumes[2];
  for (int k : {0, 1}) {
    skin.points = points.at(moved[k]);
    volumes[k] = volume(skin);
  }
  EXPECT_NEAR(power, -2000 * (volumes[1] - volumes[0]) / (2 * by), 1e-6 * std::abs(power));
}

TEST(Loads, TurnWithTheSurfaceOnlyIfTheyArePressures) {
  const Points rest = test::fcc_box(7, 7, 15, r);
  Triangles skin = around(rest), top = skin;
  top.faces.clear();
  const double z = bounds(skin.points).max().z();
  for (const auto& face : skin.faces)
    if (skin.points[face[0]].z() == z && skin.points[face[1]].z() == z &&
        skin.points[face[2]].z() == z)
      top.faces.push_back(face);
  const Load pressure = pressure_load("press", top, 1000, rest, r);
  const AreaWeights weights = area_weights(top, rest, r);
  const Load traction =
      force_load("pull", weights.particles, weights.weights, {0, 0, -1000 * weights.area}, rest);
  const Mat3 turn = test::turned({0, 1, 0}, 90);
  const Points now = test::affine(rest, turn);
  const double side = bounds(skin.points).sizes().x(), area = side * side;
  for (const Load* load : {&pressure, &traction}) {
    LoadNow at(*load);
    at.find(
        {}, [&](std::size_t k) { return now[load->particles[k]]; }, false);
    const Vec3 expected = load == &pressure ? Vec3(-1000 * area, 0, 0) : Vec3(0, 0, -1000 * area);
    EXPECT_LT((force_of(*load, at) - expected).norm(), 1e-9 * 1000 * area);
    EXPECT_LT((load->pivot - Vec3(0, 0, z)).norm(), 1e-9 * r);
  }
}

TEST(Loads, AreTheSameBitsOnAnyNumberOfThreads) {
  const Points rest = test::fcc_box(13, 13, 25, r), now = deformed(rest);
  const auto forces = [&](int threads) {
    Points found;
    with_threads(threads, [&] {
      const Load load = pressure_load("press", around(rest), 2000, rest, r);
      LoadNow at(load);
      at.find(
          {0.7}, [&](std::size_t k) { return now[load.particles[k]]; }, false);
      for (std::size_t k = 0; k < load.particles.size(); ++k) found.push_back(at.force(k));
    });
    return found;
  };
  const Points one = forces(1), three = forces(3);
  ASSERT_EQ(one.size(), three.size());
  for (std::size_t k = 0; k < one.size(); ++k) ASSERT_EQ(one[k], three[k]);
}

/// A closed surface's forces at one step after another, and how far they are off at each.
struct Followed {
  int found = 0;        ///< how often they were found anew
  double farthest = 0;  ///< from those of the moment, over those
  double mean = 0;      ///< of these differences, summed before their size is taken
};

Followed followed(const Points& rest, const std::function<Vec3(const Vec3&, int)>& motion) {
  constexpr int steps = 320;
  const Load load = pressure_load("press", around(rest), 2000, rest, r);
  LoadNow kept(load);
  Points sum(load.particles.size(), Vec3::Zero());
  double size = 0;
  Followed result;
  for (int step = 0; step < steps; ++step) {
    const auto position = [&](std::size_t k) { return motion(rest[load.particles[k]], step); };
    LoadNow exact(load);
    exact.find({}, position, false);
    if (kept.find({}, position, true)) ++result.found;
    double off = 0;
    size = 0;
    for (std::size_t k = 0; k < sum.size(); ++k) {
      const Vec3 difference = kept.force(k) - exact.force(k);
      sum[k] += difference / steps;
      off += difference.squaredNorm();
      size += exact.force(k).squaredNorm();
    }
    result.farthest = std::max(result.farthest, std::sqrt(off / size));
  }
  double off = 0;
  for (const Vec3& one : sum) off += one.squaredNorm();
  result.mean = std::sqrt(off / size);
  return result;
}

TEST(Loads, OfPressuresHoldForStepsWhileTheSurfaceTurnsEvenly) {
  const Points rest = test::fcc_box(7, 7, 15, r);
  constexpr double in_step = 1e-3;
  const Followed turning = followed(rest, [](const Vec3& at, int step) -> Vec3 {
    return Eigen::AngleAxisd(in_step * step, Vec3(1, 2, 3).normalized()) * at;
  });
  EXPECT_LT(turning.found, 320 / PressedFaces::max_steps + 6);
  EXPECT_LT(turning.farthest, 8.5 * in_step);  // from the middle of 16 steps
  EXPECT_LT(turning.mean, 2e-4);               // none of it lasts
  const Followed resting = followed(rest, [](const Vec3& at, int) { return at; });
  EXPECT_LT(resting.found, 320 / PressedFaces::max_steps + 6);
  EXPECT_LT(resting.farthest, 1e-12);
}

TEST(Loads, OfPressuresAreFoundInEveryStepWhereTheSurfaceShakes) {
  const Points rest = test::fcc_box(7, 7, 15, r);
  const Followed shaking = followed(rest, [](const Vec3& at, int step) -> Vec3 {
    return (1 + 0.02 * std::sin(step * std::numbers::pi / 5)) * at;
  });
  EXPECT_GT(shaking.found, 310);
  EXPECT_LT(shaking.farthest, 1e-12);
  const Followed slower = followed(rest, [](const Vec3& at, int step) -> Vec3 {
    return (1 + 0.002 * std::sin(step * std::numbers::pi / 50)) * at;
  });
  EXPECT_LT(slower.found, 160);
  EXPECT_LT(slower.farthest, 0.003);
}

/// Without damping, what a body stores and the volume that its pressure has taken stay in balance,
/// however long it swings.
TEST(Loads, OfPressuresKeepTheEnergyOfABodyThatSwings) {
  Machine machine;
  machine.settings.material.damping = 0;
  Triangles skin = around(machine.rest);
  constexpr double pressure = 300;
  machine.world.loads = {pressure_load("press", skin, pressure, machine.rest, r)};
  const FollowingPoints points = following(skin.points, machine.rest, r, followed_by_corners);
  Simulation simulation = machine.begin();
  const auto all = [&] {
    Points now(machine.rest.size());
    const Particles& particles = simulation.particles();
    for (std::size_t i = 0; i < now.size(); ++i) now[particles.id[i]] = particles.position(i);
    skin.points = points.at(now);
    return simulation.energies().stored() + pressure * volume(skin);
  };
  simulation.step();
  const double start = all();
  double swung = 0;
  while (simulation.steps() < 4000) {
    simulation.step();
    swung = std::max(swung, simulation.energies().kinetic);
  }
  EXPECT_NEAR(all(), start, 0.02 * swung);
}

TEST(Loads, OfPressuresAreThoseOfTheMomentInEquilibrium) {
  Machine machine;
  machine.world.supports = {{"clamp", machine.bottom()}};
  const Triangles skin = around(machine.rest);
  machine.world.loads = {pressure_load("press", skin, 600, machine.rest, r),
                         machine.pull(machine.top(), {0.05, 0, 0})};
  Simulation simulation = machine.at_rest();
  const Particles& particles = simulation.particles();
  Points now(machine.rest.size());
  for (std::size_t i = 0; i < now.size(); ++i) now[particles.id[i]] = particles.position(i);
  const Load& load = machine.world.loads[0];
  LoadNow exact(load);
  exact.find(
      {}, [&](std::size_t k) { return now[load.particles[k]]; }, false);
  Vec3 moment = Vec3::Zero();
  for (std::size_t k = 0; k < load.particles.size(); ++k)
    moment += (now[load.particles[k]] - load.pivot).cross(exact.force(k));
  const Reaction reaction = simulation.load_reactions()[0];
  EXPECT_LT((reaction.force - force_of(load, exact)).norm(), 1e-6 * exact.size());
  EXPECT_LT((reaction.moment - moment).norm(), 1e-6 * exact.size() * r);
}

/// A load that grows does what a body stores and loses.
TEST(Loads, DoTheWorkThatTheBodyStoresAndLoses) {
  for (const NeighborSearch search : {NeighborSearch::lists, NeighborSearch::cells}) {
    Machine machine;
    machine.settings.solver.neighbor_search = search;
    machine.world.supports = {{"clamp", machine.bottom()}};
    machine.world.loads = {machine.pull(machine.top(), {0, 0.05, 0.2}),
                           pressure_load("press", around(machine.rest), 300, machine.rest, r)};
    Load spring = spring_load("spring", machine.rest[machine.top().front()], 2, machine.rest, r);
    spring.scale = {{0, 0.05}, {0, 1}};
    spring.free_end = {{0, 0.2}, {{0.3, 0, 0}, {0.5, 0.1, 0.3}}};
    machine.world.loads.push_back(spring);
    machine.world.loads[0].scale = {{0, 0.1}, {0, 1}};
    machine.world.loads[1].scale = {{0, 0.2}, {0, 1}};
    Simulation simulation = machine.begin();
    const Energies start = simulation.energies();
    while (simulation.time() < 0.2) simulation.step();
    const Energies end = simulation.energies();
    EXPECT_GT(end.work_of_world, 1e-5);
    EXPECT_NEAR(end.stored() - start.stored(), end.work() - (end.dissipation - start.dissipation),
                0.005 * end.work_of_world);
  }
}

/// The force of a spring is its stiffness times the way from its point, which follows the body, to
/// its free end, wherever that is; it has no part in the other loads.
TEST(Loads, OfSpringsPullTheirPointToTheirFreeEnd) {
  for (const bool one : {false, true}) {
    Machine machine;
    machine.world.supports = {{"clamp", machine.bottom()}};
    const std::uint32_t particle = machine.top().front();
    Load spring = one ? spring_load("spring", particle, 3, machine.rest)
                      : spring_load("spring", machine.rest[particle], 3, machine.rest, r);
    spring.free_end = {{0, 1}, {machine.rest[particle] + Vec3(3 * r, 0, r), {0, 0, 0}}};
    machine.world.loads = {spring};
    Simulation simulation = machine.at_rest();
    const Points now = positions_by_id(simulation.particles());
    Vec3 point = Vec3::Zero();
    for (std::size_t k = 0; k < spring.particles.size(); ++k)
      point += spring.weight[k] * now[spring.particles[k]];
    const Vec3 force = 3 * (spring.free_end.places[0] - point);
    EXPECT_GT((point - machine.rest[particle]).norm(), 0.01 * r);
    EXPECT_LT((simulation.load_reactions()[0].force - force).norm(), 1e-6 * force.norm());
    EXPECT_LT((simulation.support_reactions()[0].force + force).norm(), 1e-4 * force.norm());
  }
}

TEST(Loads, PowerIsForceTimesVelocity) {
  Machine machine;
  machine.world.loads = {machine.pull(machine.top(), {0, 0, 0.5})};
  Simulation simulation = machine.begin();
  while (simulation.time() < 0.05) simulation.step();
  const Reaction on = simulation.load_reactions()[0];
  Vec3 velocity = Vec3::Zero();
  for (const std::uint32_t i : machine.top())
    velocity += simulation.particles().velocity(i) / static_cast<double>(machine.top().size());
  EXPECT_GT(velocity.z(), 0.01);
  EXPECT_NEAR(on.power, 0.5 * velocity.z(), 0.1 * on.power);  // half a step later
}

TEST(Loads, BadOnesAreRefused) {
  const Points rest = test::fcc_box(5, 5, 5, r);
  test::expect_bad_input(
      [&] {
        force_load("pull", {}, {}, {0, 0, 1}, rest);
      },
      {"load 'pull' acts on nothing"});
  Load load = force_load("pull", {1}, {2}, {0, 0, 1}, rest);
  EXPECT_EQ(load.weight[0], 1);
  load.scale = {{1, 0}, {0, 1}};
  test::expect_bad_input([&] { check_load(load); }, {"load 'pull' has a key at 0 s"});
  load.scale = {};
  load.pressure = NAN;
  test::expect_bad_input([&] { check_load(load); }, {"load 'pull' is not finite"});
}

}  // namespace sinew::loads_test
