// SPDX-License-Identifier: GPL-3.0-or-later
// Combinations of materials, damping, bones, surroundings and integrators in which each value of
// one meets each of any other: the kernel takes the steps that the readable reference takes, in
// both precisions. With SINEW_ALL_COMBINATIONS in the environment, all of them.
#include <array>
#include <cstdlib>
#include <functional>
#include <numeric>
#include <set>

#include "support/all_steppers.h"
#include "support/surroundings.h"

namespace sinew::every_setting_test {

using namespace surroundings;

constexpr int height = 11;

struct Choice {
  std::string name;
  std::function<void(Settings&)> choose;
};

std::vector<Choice> materials() {
  return {{"paper", [](Settings&) {}},
          {"initial_neighbors",
           [](Settings& settings) { settings.material.cohesion = Cohesion::initial_neighbors; }},
          {"bonded", [](Settings& settings) { settings.material.model = MaterialModel::bonded; }},
          {"bonded_volume",
           [](Settings& settings) { settings.material.model = MaterialModel::bonded_volume; }},
          {"bonded, changing",
           [](Settings& settings) {
             settings.material.model = MaterialModel::bonded;
             settings.material.breaking_strain = 0.02;
             settings.material.yield_strain = 0.01;
             settings.material.creep_rate = 50;
           }},
          {"bonded_volume, changing",
           [](Settings& settings) {
             settings.material.model = MaterialModel::bonded_volume;
             settings.material.breaking_strain = 0.02;
             settings.material.yield_strain = 0.01;
           }},
          {"bonded, relaxing", [](Settings& settings) {
             settings.material.model = MaterialModel::bonded;
             settings.material.relaxation_shares = {0.2, 0.3};
             settings.material.relaxation_times = {0.001, 0.2};
           }}};
}

std::vector<Choice> dampings() {
  std::vector<Choice> all{{"undamped", [](Settings& settings) { settings.material.damping = 0; }}};
  for (const auto& [name, form] :
       {std::pair{"paper", DampingForm::paper}, std::pair{"symmetric", DampingForm::symmetric},
        std::pair{"central", DampingForm::central}})
    all.push_back(
        {name, [form = form](Settings& settings) { settings.material.damping_form = form; }});
  return all;
}

std::vector<Choice> bones() {
  const auto stretch = [](Settings& settings) { settings.tracks[1].keys.back().stretch = 1.05; };
  return {
      {"servo", [](Settings&) {}},
      {"joint zone", [](Settings& settings) { settings.binding.joint_zone = 2; }},
      {"open loop", [](Settings& settings) { settings.binding.twist_form = TwistForm::open_loop; }},
      {"anchor", [](Settings& settings) { settings.binding.force = BoneForce::anchor; }},
      {"stretching", stretch},
      {"stretching anchor",
       [=](Settings& settings) {
         stretch(settings);
         settings.binding.force = BoneForce::anchor;
       }},
      {"none", [](Settings& settings) { settings = test::unbound(settings); }}};
}

Settings moving_scene() {
  Settings settings = test::box_scene(height);
  KeyDefinition end = test::bend_key(0.1, 20);
  end.twist = 15;
  settings.tracks = {test::track("lower", {test::bend_key(-0.1, 0), test::bend_key(0.1, -5)}),
                     test::track("upper", {test::bend_key(-0.1, 0), end})};
  return settings;
}

struct Story {
  Settings settings;
  Points rest = test::fcc_box(5, 5, height, r);
  Body body;
  Particles particles;
  double step;

  Story(const Settings& chosen, const Around& around) : settings(chosen) {
    body = test::make_body(settings, rest);
    particles = test::shaken(rest, body.material, 0.02 * r, 0.05);
    step = settings.material.damping == 0 ? 1e-4 : test::step_of(settings, body, 0.2);
    if (!around.surround) return;
    World world;
    around.surround(rest, body.material, world);
    body.world = std::make_shared<const World>(world);
  }

  Simulation begin(NeighborSearch search, Precision precision) const {
    Settings in = settings;
    in.solver.neighbor_search = search;
    in.solver.precision = precision;
    return Simulation(body, motion_of(in, body.skeleton), particles, stepping_of(in.solver, step));
  }
};

double largest(const Points& a, const Points& b) {
  double most = 0;
  EXPECT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    most = std::max(most, (a[i] - b[i]).norm());
  return most;
}

void expect_same_ledger(const Energies& a, const Energies& b, double part) {
  const double ledger[2][8] = {{a.kinetic, a.gravity, a.pair, a.bone, a.work_of_bones,
                                a.dissipation, a.contact, a.work_of_world},
                               {b.kinetic, b.gravity, b.pair, b.bone, b.work_of_bones,
                                b.dissipation, b.contact, b.work_of_world}};
  double scale = 1e-9;
  for (const double energy : ledger[1]) scale = std::max(scale, std::abs(energy));
  for (int k = 0; k < 8; ++k) EXPECT_NEAR(ledger[0][k], ledger[1][k], part * scale) << k;
}

void expect_same(const std::vector<Reaction>& on, const std::vector<Reaction>& expected,
                 double force) {
  ASSERT_EQ(on.size(), expected.size());
  for (std::size_t k = 0; k < on.size(); ++k) {
    EXPECT_LE((on[k].force - expected[k].force).norm(), force);
    EXPECT_LE((on[k].moment - expected[k].moment).norm(), force * r * height);
    EXPECT_NEAR(on[k].power, expected[k].power, force);
  }
}

void expect_same(Simulation& kernel, Simulation& reference, double part) {
  const Material& material = reference.body().material;
  EXPECT_LE(test::largest_distance(kernel.particles(), reference.particles()), part * r);
  const Forces &f = kernel.forces(), &g = reference.forces();
  const double force = material.stiffness() * r;
  EXPECT_LE(largest(f.pair, g.pair), 10 * part * force);
  EXPECT_LE(largest(f.damping, g.damping), 10 * part * force);
  EXPECT_LE(largest(f.bone, g.bone), 10 * part * force);
  EXPECT_LE(largest(f.world, g.world), 10 * part * force);
  expect_same_ledger(kernel.energies(), reference.energies(), part);
  expect_same(kernel.reactions_of_obstacles(), reference.reactions_of_obstacles(),
              100 * part * force);
  expect_same(kernel.support_reactions(), reference.support_reactions(), 100 * part * force);
  expect_same(kernel.load_reactions(), reference.load_reactions(), 100 * part * force);
}

void expect_same_steps(const Settings& settings, const Around& around) {
  const Story story(settings, around);
  Simulation reference = story.begin(NeighborSearch::cells, Precision::binary64);
  Simulation doubles = story.begin(NeighborSearch::lists, Precision::binary64);
  Simulation floats = story.begin(NeighborSearch::lists, Precision::binary32);
  EXPECT_EQ(reference.list_counts().rebuilds, 0);
  while (reference.steps() < 15) reference.step(), doubles.step(), floats.step();
  EXPECT_GT(doubles.list_counts().rebuilds, 0);
  EXPECT_GT(floats.list_counts().rebuilds, 0);
  expect_same(doubles, reference, 1e-11);
  EXPECT_EQ(doubles.forces().neighbors, reference.forces().neighbors);
  EXPECT_EQ(doubles.broken_bonds(), reference.broken_bonds());
  if (settings.material.breaking_strain) return;  // rounding decides which bonds break first
  expect_same(floats, reference, 3e-4);
}

std::vector<Choice> integrators() {
  std::vector<Choice> all;
  for (const auto& [name, integrator] :
       {std::pair{"symplectic Euler", Integrator::symplectic_euler},
        std::pair{"explicit Euler", Integrator::explicit_euler},
        std::pair{"velocity Verlet", Integrator::velocity_verlet}})
    all.push_back({name, [integrator = integrator](Settings& settings) {
                     settings.solver.integrator = integrator;
                   }});
  return all;
}

/// The place of a value in the list of each setting: material, bones, surroundings, damping,
/// integrator.
using Combination = std::array<std::size_t, 5>;

Combination counts() {
  return {materials().size(), bones().size(), all_surroundings().size(), dampings().size(),
          integrators().size()};
}

std::vector<Combination> all_combinations() {
  const Combination count = counts();
  const auto product =
      std::accumulate(count.begin(), count.end(), std::size_t(1), std::multiplies());
  std::vector<Combination> all(product);
  for (std::size_t n = 0; n < product; ++n)
    for (std::size_t k = 0, rest = n; k < count.size(); rest /= count[k++])
      all[n][k] = rest % count[k];
  return all;
}

std::size_t prime_from(std::size_t n) {
  const auto divides = [&](std::size_t d) { return n % d == 0; };
  for (;; ++n) {
    std::size_t d = 2;
    while (d < n && !divides(d)) ++d;
    if (d >= n) return n;
  }
}

/// In a space of p x p x p points, p a prime number, planes of three directions cross in one point:
/// the settings are directions along (1, k, k^2), and their values are planes (an orthogonal array
/// of Bush's).
std::vector<Combination> chosen_combinations() {
  const Combination count = counts();
  const std::size_t p =
      prime_from(std::max(count.size(), *std::max_element(count.begin(), count.end())));
  std::vector<Combination> chosen(p * p * p);
  for (std::size_t n = 0; n < chosen.size(); ++n)
    for (std::size_t k = 0; k < count.size(); ++k)
      chosen[n][k] = (n % p + k * (n / p % p) + k * k * (n / p / p)) % p % count[k];
  return chosen;
}

TEST(Combinations, HoldAllValuesOfAnyThreeSettings) {
  const Combination count = counts();
  const std::vector<Combination> chosen = chosen_combinations();
  EXPECT_LT(10 * chosen.size(), all_combinations().size());
  for (std::size_t a = 0; a < count.size(); ++a)
    for (std::size_t b = a + 1; b < count.size(); ++b)
      for (std::size_t c = b + 1; c < count.size(); ++c) {
        std::set<std::array<std::size_t, 3>> met;
        for (const Combination& one : chosen) met.insert({one[a], one[b], one[c]});
        EXPECT_EQ(met.size(), count[a] * count[b] * count[c]) << a << ", " << b << ", " << c;
      }
}

void expect_same_steps(const Combination& combination) {
  const Around around = all_surroundings()[combination[2]];
  Settings settings = moving_scene();
  std::string name = around.name;
  for (const Choice& choice : {materials()[combination[0]], bones()[combination[1]],
                               dampings()[combination[3]], integrators()[combination[4]]}) {
    choice.choose(settings);
    name += ", " + choice.name;
  }
  SCOPED_TRACE(name);
  expect_same_steps(settings, around);
}

class EverySetting : public testing::TestWithParam<std::size_t> {};

TEST_P(EverySetting, StepsInTheKernelAsInTheReference) {
  const bool all = std::getenv("SINEW_ALL_COMBINATIONS");
  for (const Combination& one : all ? all_combinations() : chosen_combinations()) {
    if (one[0] != GetParam()) continue;
    expect_same_steps(one);
    if (testing::Test::HasFailure()) return;
  }
}

INSTANTIATE_TEST_SUITE_P(Of, EverySetting, testing::Range<std::size_t>(0, materials().size()),
                         [](const auto& test) {
                           std::string name = materials()[test.param].name;
                           std::erase_if(name,
                                         [](char c) { return c == ',' || c == ' ' || c == '_'; });
                           return name;
                         });

TEST(Combinations, AreSteppedForEachMaterial) {
  const testing::UnitTest& program = *testing::UnitTest::GetInstance();
  int stepped = 0;
  for (int k = 0; k < program.total_test_suite_count(); ++k)
    if (const testing::TestSuite& suite = *program.GetTestSuite(k);
        suite.name() == std::string("Of/EverySetting"))
      stepped = suite.total_test_count();
  EXPECT_EQ(stepped, static_cast<int>(materials().size()));
}

}  // namespace sinew::every_setting_test
