// SPDX-License-Identifier: GPL-3.0-or-later
// Small bodies run all features of the physics for some steps; their final states are compared with
// the files in golden/.
#include <gtest/gtest.h>

#include <sinew/analysis/elastic_modes.h>
#include <sinew/analysis/time_step.h>
#include <sinew/scene/prepare.h>
#include <sinew/scene/rig.h>
#include <sinew/stepping/simulation.h>
#include <sinew/world/world.h>

#include "support/golden.h"
#include "support/world.h"

namespace sinew::golden_test {

constexpr double r = 0.01;
constexpr int height = 9;  // half-planes

std::string row(const std::string& name, const std::vector<double>& values) {
  std::string text = name;
  for (const double value : values) text += ',' + test::rounded(value);
  return text + '\n';
}

void append(std::vector<double>& values, const Vec3& vector) {
  values.insert(values.end(), vector.begin(), vector.end());
}

struct Story {
  std::string name;
  Settings settings = test::box_scene(height);
  World world = {};
  int steps = 60;
  Points rest = test::fcc_box(5, 5, height, r);
  double shake = 0.05 * r, speed = 0.02;  ///< at the start, m and m/s

  Story(std::string name_) : name(std::move(name_)) {
    settings.solver.gravity = {1, 0.5, -4};
    settings.tracks = {test::track("upper", {test::bend_key(0, 0), test::bend_key(0.05, 12)})};
  }

  /// The final state.
  std::string end() const {
    Body body = test::make_body(settings, rest);
    body.world = std::make_shared<const World>(world);
    const Particles particles = test::shaken(rest, body.material, shake, speed);
    const WorldLoad load = {added_stiffness(world, particles), added_damping(world, particles)};
    const double limit =
        step_limit(Integrator::symplectic_euler, body.material, body.springs, load);
    Simulation simulation(body, motion_of(settings, body.skeleton), particles,
                          stepping_of(settings.solver, limit / 4));
    const std::string start = row(name + " start", numbers(simulation, limit));
    for (int step = 0; step < steps; ++step) simulation.step();
    return start + row(name + " end", numbers(simulation, limit));
  }

 private:
  static std::vector<double> numbers(Simulation& simulation, double limit) {
    std::vector<double> values{limit, simulation.time()};
    const Energies energies = simulation.energies();
    values.insert(values.end(), {energies.kinetic, energies.pair, energies.bone, energies.gravity,
                                 energies.work_of_bones, energies.dissipation, energies.contact,
                                 energies.work_of_world});
    const Forces& forces = simulation.forces();
    const Particles& particles = simulation.particles();
    for (std::size_t i = 3; i < particles.size(); i += 37) {
      append(values, particles.position(i));
      append(values, particles.velocity(i));
      append(values, forces.pair[i]);
      append(values, forces.damping[i]);
      append(values, forces.bone[i]);
      if (!forces.world.empty()) append(values, forces.world[i]);
    }
    double broken = 0;
    for (const int bonds : simulation.broken_bonds()) broken += bonds;
    values.push_back(broken);
    for (const Reaction& reaction : simulation.reactions_of_obstacles()) {
      append(values, reaction.force);
      append(values, reaction.moment);
      values.push_back(reaction.power);
    }
    return values;
  }
};

TEST(Golden, IntegratorsAndDampingsEndWhereTheyDid) {
  std::string text;
  for (const auto& [integrator, name] : {std::pair{Integrator::symplectic_euler, "symplectic"},
                                         {Integrator::explicit_euler, "explicit"},
                                         {Integrator::velocity_verlet, "verlet"}})
    for (const auto& [form, damping] : {std::pair{DampingForm::paper, "paper"},
                                        {DampingForm::symmetric, "symmetric"},
                                        {DampingForm::central, "central"}}) {
      Story story(std::string(name) + ' ' + damping);
      story.settings.solver.integrator = integrator;
      story.settings.material.damping_form = form;
      text += story.end();
      if (form != DampingForm::paper) continue;
      story.name += " by lists";
      story.settings.solver.neighbor_search = NeighborSearch::lists;
      text += story.end();
    }
  test::expect_golden("stepping/golden/integrators.csv", text);
}

TEST(Golden, MaterialsEndWhereTheyDid) {
  std::string text;
  Story soft("soft in tension");
  soft.settings.material.lambda = 0.5;
  soft.settings.material.b = 2.9;
  soft.settings.material.a = 2.05;
  text += soft.end();
  Story ratio("by damping ratio along a direction");
  ratio.settings.material.damping_ratio = 0.1;
  ratio.settings.material.modulus_direction = Vec3(1, 1, 0);
  text += ratio.end();
  Story given("of given stiffness");
  given.settings.material.k1 = 3e5;
  given.settings.material.k2 = 2e5;
  text += given.end();
  Story neighbors("initial neighbors");
  neighbors.settings.material.cohesion = Cohesion::initial_neighbors;
  text += neighbors.end();
  for (const auto& [model, name] : {std::pair{MaterialModel::bonded, "bonded"},
                                    {MaterialModel::bonded_volume, "bonded volume"}}) {
    Story bonded(name);
    bonded.settings.material.model = model;
    text += bonded.end();
    bonded.name += " that creeps and breaks";
    bonded.shake = 0.3 * r;
    std::swap(bonded.rest.front(),
              bonded.rest[bonded.rest.size() / 2]);  // one with neighbors on all sides
    bonded.settings.material.yield_strain = 0.05;
    bonded.settings.material.creep_rate = 40;
    bonded.settings.material.breaking_strain = 0.1;
    text += bonded.end();
  }
  test::expect_golden("stepping/golden/materials.csv", text);
}

TEST(Golden, BonesPullAsTheyDid) {
  std::string text;
  Story twist("twist, open loop, joint zone");
  twist.settings.tracks = {
      test::track("upper", {test::twist_key(0, 0), test::twist_key(0.05, 25)})};
  twist.settings.binding.twist_form = TwistForm::open_loop;
  twist.settings.binding.joint_zone = 2;
  text += twist.end();
  Story anchor("anchor");
  anchor.settings.binding.force = BoneForce::anchor;
  text += anchor.end();
  for (const auto& [search, word] :
       {std::pair{NeighborSearch::cells, "cells"}, {NeighborSearch::lists, "lists"}}) {
    Story strong(std::string("strengths of each bone by ") + word);
    strong.settings.solver.neighbor_search = search;
    strong.settings.tracks[0].keys[1].twist = 20;
    strong.settings.bones[1].stiffness = 2;
    strong.settings.bones[0].twist_stiffness = 0.5;
    strong.settings.bones[1].axial_stiffness = 3;
    strong.settings.binding.bone_damping = 0.5;
    text += strong.end();
    strong.name += ", a wide joint zone";  // some blocks of particles have no particle of one bone
    strong.settings.binding.joint_zone = 8;
    text += strong.end();
  }
  Story longer("a bone that stretches");
  longer.settings.tracks[0].keys[1].stretch = 1.2;
  text += longer.end();
  test::expect_golden("stepping/golden/bones.csv", text);
}

Obstacle obstacle(const Story& story, const std::string& name, const Shape& shape) {
  const Material material = test::material_of(story.settings);
  Obstacle made;
  made.name = name;
  made.shape = shape;
  made.stiffness = material.pair.contact_stiffness();
  made.damping = 0.5 * std::sqrt(made.stiffness * material.mass);
  made.friction = 0.4;
  return made;
}

TEST(Golden, WorldsPushAsTheyDid) {
  std::string text;
  Story walls("walls");
  const double top = height * half_plane_spacing(r), side = 2.5 * half_plane_spacing(r);
  Obstacle ball = obstacle(walls, "ball", SphereShape{{-0.02 - side, 0, 0.02}, 0.022});
  ball.motion = [](double time, const Pose&) {
    return ObstaclePose{{time * Vec3(0.3, 0, 0), Mat3::Identity()}, {0.3, 0, 0}, {0, 2, 0}};
  };
  Obstacle attached = obstacle(
      walls, "attached", CapsuleShape{{side, -0.1, top - 0.01}, {side, 0.1, top - 0.01}, 0.006});
  attached.motion = attached_to_bone(1, skeleton_of(walls.settings).bones[1], {});
  walls.world.obstacles = {
      obstacle(walls, "floor", PlaneShape{{0, 0, 0.3 * r}, {0.1, 0, 1}}), ball, attached,
      obstacle(
          walls, "box",
          BoxShape{{0, side + 0.015, 0.03}, {0.01, 0.018, 0.02}, test::turned({1, 2, 0}, 20)})};
  text += walls.end();
  walls.name = "walls that stick";
  for (Obstacle& one : walls.world.obstacles) one.stick = 0.3;
  text += walls.end();

  Story pins("pins");
  pins.world.pins = pinned(
      pins.rest,
      {{{BoxShape{{0, 0, 0}, {1, 1, r}}, 0}, no_bone}, {{SphereShape{{0, 0, top}, 2 * r}, 0}, 1}},
      2);
  text += pins.end();

  Story fields("fields");
  fields.world.drag = {3, {0.5, 0, 0.2}};
  fields.world.fields = {{"wind",
                          UniformAcceleration{{2, 0, 0}},
                          {SphereShape{{0, 0, 0.03}, 0.02}, 0.03},
                          {{0, 0.01, 0.02}, {0, 1, 0.3}}},
                         {"weight", ForceDensity{{0, 0, -800}}, {}, {}},
                         {"well", Attraction{{0.02, 0.01, 0}, 5, 0.02}, {}, {}},
                         {"swirl",
                          Swirl{{0, 0, 0}, {0.1, 0, 1}, 4, 0.01},
                          {BoxShape{{0, 0, 0.04}, {0.02, 0.02, 0.02}}, 0.01},
                          {}}};
  text += fields.end();

  for (const auto model : {MaterialModel::paper, MaterialModel::bonded_volume}) {
    Story muscles(model == MaterialModel::paper ? "muscles" : "muscles in a solid");
    muscles.settings.material.model = model;
    Muscle whole, part;
    whole.name = "whole";
    whole.strength = 600;
    whole.activation = {{0, 0.02}, {0, 1}};
    whole.weights = weights_in({}, muscles.rest);
    part.name = "part";
    part.direction = {1, 0.2, 0};
    part.strength = 400;
    part.weights = weights_in({SphereShape{{0, 0, 0.02}, 0.015}, 0.02}, muscles.rest);
    muscles.world.muscles = make_muscles(muscles.rest, r, {whole, part});
    text += muscles.end();
  }
  test::expect_golden("stepping/golden/worlds.csv", text);
}

TEST(Golden, ConstantsAreWhatTheyWere) {
  std::string text;
  for (const double ratio : {0.26, 0.3, 0.45}) {
    Settings settings = test::box_scene(height);
    settings.material.poisson_ratio = ratio;
    settings.material.model = MaterialModel::bonded_volume;
    const Material material = test::material_of(settings);
    const CubicConstants constants = material.constants();
    text += row("solid", {constants.C11, constants.C12, constants.C44, constants.bulk_modulus(),
                          constants.hill_shear_modulus(), constants.hill_young_modulus(),
                          constants.hill_poisson_ratio(), constants.young_modulus({1, 2, 0}),
                          constants.poisson_ratio({1, 2, 0}), material.young_modulus(),
                          material.stiffness(), volume_stiffness_for(ratio),
                          highest_frequency_factor({0, volume_stiffness_for(ratio)})});
  }
  const Points sheet = test::fcc_box(9, 9, 3, r);
  for (const Points& rest : {test::fcc_box(5, 5, height, r), sheet}) {
    Settings settings = test::box_scene(height);
    const Body body = test::make_body(settings, rest);
    const ElasticModes modes = elastic_modes(body);
    text += row("body",
                {modes.frequency(), modes.damping_ratio(body.material.damping),
                 modes.damping_for(0.2), power_step_limit(body), power_step_limit(body, {200, 30}),
                 is_thin(test::nearest(rest, r)) ? 1.0 : 0.0, lack_of_bending_stiffness(3)});
  }
  for (const auto integrator :
       {Integrator::symplectic_euler, Integrator::explicit_euler, Integrator::velocity_verlet})
    for (const auto form : {DampingForm::paper, DampingForm::symmetric, DampingForm::central})
      for (const double damping : {0.1, 0.5, 5.0}) {
        Settings settings = test::box_scene(height);
        settings.material.damping_form = form;
        settings.material.damping = damping;
        const Body body = test::make_body(settings, test::fcc_box(5, 5, height, r));
        const double limit = step_limit(integrator, body.material, body.springs);
        text += row("limit", {limit, step_limit(integrator, body.material, body.springs, {500, 20}),
                              step_limit(integrator, body.material, {})});
      }
  test::expect_golden("stepping/golden/constants.csv", text);
}

}  // namespace sinew::golden_test
