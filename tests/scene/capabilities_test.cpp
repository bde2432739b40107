// SPDX-License-Identifier: GPL-3.0-or-later
// The table of what may be combined tells the truth: what it excludes is refused with its words,
// and all else steps, or becomes finite elements.
#include <sinew/core/capabilities.h>

#include <functional>
#include <map>

#include <gtest/gtest.h>

#include <sinew/engine/engine_files.h>
#include <sinew/scene/finite_elements.h>
#include <sinew/scene/prepare.h>
#include <sinew/settings/read_scene.h>
#include <sinew/world/features.h>
#include "mesh/shapes.h"
#include "support/expect_error.h"
#include "support/temp_folder.h"

namespace sinew::capabilities_test {

using enum Feature;
using Choose = std::function<void(Settings&)>;

Settings bar() {
  Settings scene;
  scene.meshes["bar"] = shapes::box({-0.04, -0.04, 0}, {0.04, 0.04, 0.12});
  scene.body.mesh = "bar";
  scene.body.radius = 0.01;
  scene.material.model = MaterialModel::bonded;
  scene.supports.resize(1);
  scene.supports[0].name = "clamp";
  scene.supports[0].part.facing = Vec3(0, 0, -1);
  scene.solver.duration = scene.output.interval = 0.001;
  scene.hierarchy.min_particles = 64;
  return scene;
}

void add_bones(Settings& scene) {
  scene.bones = {{"lower", "", Vec3(0, 0, 0), Vec3(0, 0, 0.06)},
                 {"upper", "lower", {}, Vec3(0, 0, 0.12)}};
}

LocalMaterialSettings& added_part(Settings& scene) {
  LocalMaterialSettings& part = scene.materials.emplace_back();
  part.name = "tip";
  part.part.point = Vec3(0, 0, 0.06);
  part.part.normal = Vec3(0, 0, 1);
  return part;
}

PartSettings top() {
  PartSettings part;
  part.facing = Vec3(0, 0, 1);
  return part;
}

/// Another entry of a list.
template <class List>
auto& added(List& list) {
  list.emplace_back().name = "added";
  return list.back();
}

RegionSettings high() {
  RegionSettings region;
  region.low = Vec3(-1, -1, 0.09);
  region.high = Vec3(1, 1, 1);
  return region;
}

/// How a scene gets each feature that its settings tell.
const std::map<Feature, Choose>& choices() {
  static const std::map<Feature, Choose> all = {
      {cells, [](Settings& s) { s.solver.neighbor_search = NeighborSearch::cells; }},
      {single_precision, [](Settings& s) { s.solver.precision = Precision::binary32; }},
      {groups, [](Settings& s) { s.hierarchy.enabled = true; }},
      {equilibria, [](Settings& s) { s.solver.method = Method::static_equilibrium; }},
      {paper, [](Settings& s) { s.material.model = MaterialModel::paper; }},
      {motion, [](Settings&) {}},
      {integrator, [](Settings& s) { s.solver.integrator = Integrator::velocity_verlet; }},
      {time_step, [](Settings& s) { s.solver.time_step = 1e-5; }},
      {residual, [](Settings& s) { s.solver.residual = 1e-3; }},
      {static_solver, [](Settings& s) { s.solver.static_solver = StaticSolver::relaxation; }},
      {velocities, [](Settings& s) { s.body.velocity = Vec3(0.1, 0, 0); }},
      {preroll, [](Settings& s) { s.motion.preroll = 0.01; }},
      {first_pose,
       [](Settings& s) {
         add_bones(s);
         s.motion.begin = Begin::pose;
         TrackDefinition& track = s.tracks.emplace_back();
         track.bone = "upper";
         KeyDefinition& key = track.keys.emplace_back();
         key.time = 0;
         key.axis = Vec3::UnitY();
         key.angle = 1;
       }},
      {bodies,
       [](Settings& s) {
         s.bodies.push_back({s.body, {}});
         s.bodies.back().body.offset = Vec3(0.2, 0, 0);
       }},
      {layer, [](Settings& s) { s.body.thickness = 0.06; }},
      {other_packing, [](Settings& s) { s.body.packing = Packing::conformal; }},
      {hcp, [](Settings& s) { s.body.packing = Packing::hcp; }},
      {modulus_direction, [](Settings& s) { s.material.modulus_direction = Vec3(1, 0, 0); }},
      {bonds, [](Settings& s) { s.material.model = MaterialModel::bonded; }},
      {bonds_alone, [](Settings& s) { s.material.model = MaterialModel::bonded; }},
      {k1, [](Settings& s) { s.material.k1 = 100; }},
      {nearest_bonds, [](Settings& s) { s.material.isotropic = false; }},
      {isotropy, [](Settings& s) { s.material.isotropic = true; }},
      {part_stiffness, [](Settings& s) { added_part(s).young_modulus = 2e4; }},
      {part_ratio,
       [](Settings& s) {
         s.material.model = MaterialModel::bonded_volume;
         added_part(s).poisson_ratio = 0.3;
       }},
      {part_volume,
       [](Settings& s) {
         s.material.model = MaterialModel::bonded_volume;
         added_part(s).young_modulus = 2e4;
       }},
      {part_density, [](Settings& s) { added_part(s).density = 2000; }},
      {breaking, [](Settings& s) { s.material.fracture_energy = 100; }},
      {yielding, [](Settings& s) { added_part(s).yield_strain = 0.1; }},
      {relaxing,
       [](Settings& s) {
         s.material.relaxation_shares = {{0.5}};
         s.material.relaxation_times = {{0.1}};
       }},
      {rayleigh,
       [](Settings& s) {
         s.material.rayleigh = {{0, 1e-5}};
       }},
      {attraction, [](Settings& s) { s.material.model = MaterialModel::paper; }},
      {one_cohesion,
       [](Settings& s) {
         s.material.model = MaterialModel::paper;
         s.material.cohesion = Cohesion::initial_neighbors;
       }},
      {friction, [](Settings& s) { s.material.friction = 0.3; }},
      {bones, add_bones},
      {pass_through,
       [](Settings& s) {
         add_bones(s);
         s.contact.pass_through.pairs = {{"lower", "upper"}};
       }},
      {open_loop, [](Settings& s) { s.binding.twist_form = TwistForm::open_loop; }},
      {max_force,
       [](Settings& s) {
         add_bones(s);
         s.binding.max_force = 1;
       }},
      {drag, [](Settings& s) { s.world.drag = 1; }},
      {obstacles, [](Settings& s) { added(s.world.obstacles); }},
      {rough_obstacles, [](Settings& s) { added(s.world.obstacles).friction = 0.3; }},
      {mesh_obstacles,
       [](Settings& s) {
         s.meshes["wall"] = shapes::box({0.1, -0.1, 0}, {0.2, 0.1, 0.1});
         added(s.world.obstacles).shape = ObstacleShape::mesh;
         s.world.obstacles.back().mesh = "wall";
       }},
      {pins, [](Settings& s) { s.world.pins.emplace_back().region = high(); }},
      {fields, [](Settings& s) { added(s.world.fields).acceleration = Vec3(0.1, 0, 0); }},
      {muscles,
       [](Settings& s) {
         auto& muscle = added(s.world.muscles);
         muscle.direction = Vec3(0, 0, 1);
         muscle.strength = 10;
         muscle.region = high();
       }},
      {supports_along,
       [](Settings& s) {
         added(s.supports).hold_along = Vec3(1, 1, 0);
         s.supports.back().part = top();
       }},
      {pressures,
       [](Settings& s) {
         added(s.loads).pressure = 1;
         s.loads.back().part = top();
       }},
      {springs,
       [](Settings& s) {
         auto& spring = added(s.world.springs);
         spring.at = Vec3(0, 0, 0.12);
         spring.stiffness = 1;
         spring.keys = {{0, Vec3(0, 0, 0.13), 1}};
       }},
  };
  return all;
}

/// Features that a command chooses, or that whoever prepares a scene does.
const Features of_commands = {lammps, elements};
const Features of_programs = {
    lists,      newton,      branches, oblique_pins,      rigid_damping,
    own_forces, mesh_fields, own_law,  own_law_of_memory, law_without_precision};

std::string name_of(Feature feature) {
  return std::string(feature_table()[static_cast<std::size_t>(feature)].words);
}

/// A scene with both; the second may be one of a command.
Settings with(Feature one, Feature other) {
  Settings scene = bar();
  for (const Feature feature : {one, other})
    if (choices().contains(feature)) choices().at(feature)(scene);
  return scene;
}

Features asked_for(Feature other) {
  return of_commands.contains(other) ? Features{other} : Features{};
}

std::optional<Conflict> first_conflict(Features all) {
  for (const Feature other : all)
    if (auto found = conflict_with(other, all)) return found;
  return {};
}

TEST(Capabilities, AreATableInTheOrderOfTheFeatures) {
  std::size_t place = 0;
  for (const FeatureRow& row : feature_table()) {
    EXPECT_EQ(static_cast<std::size_t>(row.feature), place++) << row.words;
    const int known = static_cast<int>(choices().contains(row.feature)) +
                      static_cast<int>(of_commands.contains(row.feature)) +
                      static_cast<int>(of_programs.contains(row.feature));
    EXPECT_EQ(known, 1) << row.words;
  }
  EXPECT_FALSE(first_conflict(features_of(bar())));
  for (const auto& [feature, choose] : choices()) {
    Settings scene = bar();
    choose(scene);
    EXPECT_TRUE(features_of(scene).contains(feature)) << name_of(feature);
  }
}

TEST(Capabilities, AreRefusedWithTheWordsOfTheirRow) {
  for (const FeatureRow& row : feature_table())
    for (const Exclusion& by : row.excluded_by) {
      const auto alone = conflict_with(by.other, {row.feature});
      ASSERT_TRUE(alone) << row.words;
      EXPECT_NE(alone->what.find(by.why), std::string::npos);
      if (!choices().contains(row.feature) || of_programs.contains(by.other)) continue;
      test::expect_bad_input(
          [&] { check_features(with(row.feature, by.other), asked_for(by.other)); },
          {"exclude each other", "; "});
      Features pair = features_of(with(row.feature, by.other));
      pair.insert(by.other);
      EXPECT_TRUE(conflict_with(by.other, pair)) << row.words << ", " << name_of(by.other);
    }
}

/// Takes a step, or writes the deck or the files of an engine.
void use(const Settings& scene, Feature by) {
  if (by == elements) {
    deck_of(scene, read_mesh(scene), {.size = 0.04, .frequencies = 1});
    return;
  }
  Prepared prepared = prepare({scene});
  const Motion motion = prepared.motion;
  Simulation simulation = start(std::move(prepared));
  if (by != lammps) return simulation.step();
  const TempFolder folder;
  const StepPlan plan(1e-5, 1, {1});
  const SimulationState state = simulation.save();
  write_engine_run({folder.path() / "engine"},
                   {simulation.body(), motion, simulation.stepping(), plan, 1, 1,
                    simulation.particles().mass, state, simulation.particles().id});
}

TEST(Capabilities, AreThereWhereNothingExcludesThem) {
  for (const Feature by : {cells, lists, single_precision, groups, equilibria, lammps, elements})
    for (const auto& [feature, choose] : choices()) {
      const Settings scene = with(feature, by);
      Features all = features_of(scene);
      all.merge(asked_for(by));
      if (first_conflict(all)) continue;
      EXPECT_NO_THROW({
        try {
          use(scene, by);
        } catch (const Error& error) {
          ADD_FAILURE() << name_of(feature) << ", " << name_of(by) << ": " << error.what();
        }
      });
    }
}

TEST(Capabilities, OfABodyAreThoseOfItsScene) {
  const Features of_both = {
      groups,    paper,   part_volume, part_density,    breaking,       yielding,
      relaxing,  drag,    friction,    pass_through,    fields,         max_force,
      obstacles, muscles, pressures,   rough_obstacles, mesh_obstacles, springs};
  for (const auto& [feature, choose] : choices()) {
    Settings scene = bar();
    choose(scene);
    if (first_conflict(features_of(scene)) || feature == layer) continue;
    const Features asked = features_of(scene), found = features_of(prepare({scene}).body);
    for (const Feature one : of_both)
      EXPECT_EQ(asked.contains(one), found.contains(one))
          << name_of(feature) << ": " << name_of(one);
  }
}

}  // namespace sinew::capabilities_test
