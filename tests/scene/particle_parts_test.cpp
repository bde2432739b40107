// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/particle_parts.h>

#include <gtest/gtest.h>

#include <sinew/mesh/surface.h>
#include <sinew/scene/machine.h>

#include <sinew/analysis/time_step.h>

#include "support/expect_error.h"
#include "support/scratch.h"
#include "support/world.h"

namespace sinew::particle_parts_test {

constexpr double r = 0.01;

/// The surface of an upright box, in 12 triangles.
Triangles box_around(const Points& rest) {
  const Box box(bounds(rest).min() - Vec3::Constant(0.6 * r),
                bounds(rest).max() + Vec3::Constant(0.6 * r));
  Triangles made;
  for (int k = 0; k < 8; ++k) made.points.push_back(box.corner(static_cast<Box::CornerType>(k)));
  const int quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                           {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& [a, b, c, d] : quads) {
    made.faces.push_back({a, b, c});
    made.faces.push_back({a, c, d});
  }
  return made;
}

struct World {
  Settings settings = test::box_scene(15);
  Points rest = test::fcc_box(7, 7, 15, r);
  Body body = test::make_body(settings, rest);
  Triangles surface = box_around(rest);
  std::vector<std::int32_t> component = std::vector<std::int32_t>(rest.size(), 0);
  ParticleParts parts{settings, body, surface, component};

  std::vector<std::uint32_t> where(const std::function<bool(const Vec3&)>& holds) const {
    std::vector<std::uint32_t> ids;
    for (std::uint32_t i = 0; i < rest.size(); ++i)
      if (holds(rest[i])) ids.push_back(i);
    return ids;
  }
};

TEST(ParticleParts, OfASurfaceAreTheParticlesNextToIt) {
  const World world;
  PartSettings top;
  top.facing = Vec3(0, 0, 3);
  const double high = world.rest.back().z();
  EXPECT_EQ(world.parts.particles(top, "supports[0]"),
            world.where([&](const Vec3& p) { return p.z() == high; }));
  const Triangles faces = world.parts.faces(top, "loads[0]");
  Vec3 sum = Vec3::Zero();
  for (const auto& face : faces.faces) sum += area_vector(faces, face);
  const double side = bounds(world.surface.points).sizes().x();
  EXPECT_LT((sum - Vec3(0, 0, side * side)).norm(), 1e-12);
  top.facing_angle = 90;
  EXPECT_GT(world.parts.particles(top, "").size(),
            world.where([&](const Vec3& p) { return p.z() == high; }).size());
}

/// A tube along z from 0 to `height`, in 64 sectors: bore of radius a, shaft of radius b, two rims.
Triangles tube(double a, double b, double height) {
  constexpr int sectors = 64;
  Triangles made;
  for (int k = 0; k < sectors; ++k)
    for (const double radius : {a, b})
      for (const double z : {0.0, height}) {
        const double angle = 2 * pi * k / sectors;
        made.points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
      }
  for (int k = 0; k < sectors; ++k) {
    const int at = 4 * k, next = 4 * ((k + 1) % sectors);  // order: bore, bore above, shaft, above
    const int pairs[4][2] = {{1, 0}, {2, 3}, {0, 2}, {3, 1}};
    for (const auto& [p, q] : pairs) {
      made.faces.push_back({at + p, next + p, next + q});
      made.faces.push_back({at + p, next + q, at + q});
    }
  }
  return made;
}

TEST(ParticleParts, AroundAnAxisAreBoresAndShaftsWithoutTheirRims) {
  constexpr double a = 0.05, b = 0.09, height = 0.1;
  const Settings settings = test::box_scene(15);
  for (const Vec3& move : {Vec3(0, 0, 0), Vec3(3, -2, 5)}) {
    Points rest = test::fcc_box(13, 13, 8, r);
    const Vec3 middle = bounds(rest).center();
    for (Vec3& p : rest) p += Vec3(0, 0, height / 2) - middle;
    std::erase_if(rest, [&](const Vec3& p) {
      const double far = std::hypot(p.x(), p.y());
      return far < a || far > b;
    });
    for (Vec3& p : rest) p += move;
    Triangles surface = tube(a, b, height);
    ASSERT_GT(volume(surface), 0);
    for (Vec3& p : surface.points) p += move;
    const Body body = test::make_body(settings, rest);
    const ParticleParts parts(settings, body, surface, {});
    PartSettings part;
    part.axis = Vec3(0, 0, -3), part.axis_point = move + Vec3(0, 0, 7);
    const double sides = 64 * 2 * std::sin(pi / 64) * height;  // over the radius
    part.facing_axis = AxisSide::inward;
    EXPECT_NEAR(area(parts.faces(part, "")), a * sides, 1e-12);
    EXPECT_NEAR(area(parts.pressed_faces(part, "")), a * sides, 1e-12);
    part.facing_axis = AxisSide::outward;
    EXPECT_NEAR(area(parts.faces(part, "")), b * sides, 1e-12);
    part.axis_radius = (a + b) / 2;
    test::expect_bad_input([&] { parts.faces(part, "loads[0]"); }, {"no face", "loads[0]"});
    part.facing_axis = AxisSide::none;
    for (const std::uint32_t i : parts.particles(part, ""))
      EXPECT_LE(std::hypot(rest[i].x() - move.x(), rest[i].y() - move.y()), *part.axis_radius);
  }
}

TEST(ParticleParts, AreWhatIsInAllRegionsThatAreGiven) {
  const World world;
  PartSettings part;
  EXPECT_EQ(world.parts.particles(part, "").size(), world.rest.size());
  part.region.low = Vec3(-1, -1, 0.05);
  part.region.high = Vec3(1, 1, 1);
  part.point = Vec3(0, 0, 0);
  part.normal = Vec3(2, 0, 0);
  part.component = 0;
  EXPECT_EQ(world.parts.particles(part, ""),
            world.where([](const Vec3& p) { return p.z() >= 0.05 && p.x() >= 0; }));
  PartSettings round;
  round.region.center = Vec3(0, 0, 0.1);
  round.region.radius = 0.03;
  round.bone = "lower";
  const auto ball = world.parts.particles(round, "");
  for (const std::uint32_t i : ball) {
    EXPECT_LE((world.rest[i] - Vec3(0, 0, 0.1)).norm(), 0.03);
    EXPECT_EQ(world.body.binding.bone(i), 0);
  }
  round.ids = std::vector<double>{1.0 * ball[0], 0};
  EXPECT_EQ(world.parts.particles(round, ""), std::vector<std::uint32_t>{ball[0]});
}

/// A body whose part is all of it is a body of that part's material.
TEST(LocalMaterials, AreThoseThatTheyName) {
  Settings whole = test::unbound(test::box_scene(15)), parts = whole;
  for (Settings* one : {&whole, &parts}) {
    one->material.model = MaterialModel::bonded_volume;
    one->material.damping = 0;
  }
  whole.material.young_modulus = 3e4;
  whole.material.poisson_ratio = 0.42;
  whole.material.density = 1500;
  whole.material.yield_strain = 0.02;
  parts.material.young_modulus = 1e4;
  parts.material.poisson_ratio = 0.25;
  parts.materials = {{"all", 3e4, 0.42, 1500, {}, 0.02}};
  parts.materials[0].part.region.center = Vec3(0, 0, 0);
  parts.materials[0].part.region.radius = 9;
  const Points rest = test::fcc_box(7, 7, 15, r);
  const Body a = test::make_body(whole, rest), b = test::make_body(parts, rest);
  ASSERT_EQ(b.local.volume.size(), rest.size());
  for (std::size_t i = 0; i < rest.size(); ++i) {
    EXPECT_NEAR(b.local.volume[i], a.material.volume_stiffness,
                1e-12 * a.material.volume_stiffness);
    EXPECT_NEAR(b.factors.volume_weight[i], a.factors.volume_weight[i], 1e-12);
    EXPECT_NEAR(b.stiffness[i] * b.material.bond.stiffness, a.material.bond.stiffness,
                1e-12 * a.material.bond.stiffness);
    EXPECT_NEAR(b.local.yield[i], a.material.bond.yield_shear, 1e-15);
    EXPECT_EQ(b.material_number[i], 1);
    EXPECT_NEAR(mass_of(b, i, b.material.mass), a.material.mass, 1e-12 * a.material.mass);
  }
  const auto limit = [](const Body& body) {
    return step_limit(Integrator::symplectic_euler, lightest(body), body.springs, {},
                      body.factors.stiffest);
  };
  EXPECT_NEAR(limit(b) / limit(a), 1, 1e-9);
}

TEST(LocalMaterials, OfWhichTheLastCountsForWhatItGives) {
  Settings settings = test::box_scene(15);
  settings.material.model = MaterialModel::bonded;
  settings.materials = {{"stiff", 4e4}, {"weak", {}, {}, {}, 0.1, {}}};
  settings.materials[0].part.region.low = Vec3(-1, -1, 0.05);
  settings.materials[0].part.region.high = Vec3(1, 1, 1);
  settings.materials[1].part.ids = std::vector<double>{0, 1};
  settings.materials[1].part.ids->push_back(double(test::fcc_box(7, 7, 15, r).size() - 1));
  const Points rest = test::fcc_box(7, 7, 15, r);
  const Body body = test::make_body(settings, rest);
  EXPECT_EQ(body.stiffness.front(), 1);
  EXPECT_EQ(body.stiffness.back(), 4);
  EXPECT_EQ(body.material_number.front(), 2);
  EXPECT_EQ(body.material_number.back(), 2);
  EXPECT_EQ(body.local.breaking.back(), 0.1);
  EXPECT_EQ(body.local.breaking[2], never_reached);
  EXPECT_GT(body.material.bond.breaking_strain, 0);
  EXPECT_TRUE(body.local.yield.empty());
  EXPECT_TRUE(body.density.empty());
  EXPECT_TRUE(body.local.volume.empty());
}

class PartsOfMeshes : public Scratch {};

TEST_F(PartsOfMeshes, AreInsideOfThem) {
  const World world;
  const Triangles box = box_around({Vec3(0, 0, 0.04), Vec3(0.02, 0.02, 0.12)});
  std::string text;
  for (const Vec3& p : box.points)
    text += "v " + std::to_string(p.x()) + ' ' + std::to_string(p.y()) + ' ' +
            std::to_string(p.z()) + '\n';
  for (const auto& [a, b, c] : box.faces)
    text += "f " + std::to_string(a + 1) + ' ' + std::to_string(b + 1) + ' ' +
            std::to_string(c + 1) + '\n';
  PartSettings part;
  part.mesh = (folder / "inner.obj").string();
  std::ofstream(part.mesh) << text;
  const Box inner = bounds(box.points);
  EXPECT_EQ(world.parts.particles(part, ""),
            world.where([&](const Vec3& p) { return inner.contains(p); }));
  std::ofstream(part.mesh) << text.substr(0, text.rfind("f "));
  test::expect_bad_input([&] { world.parts.particles(part, "materials[0]"); }, {"is open"});
  part.mesh = (folder / "none.obj").string();
  test::expect_bad_input([&] { world.parts.particles(part, "materials[0]"); }, {"none.obj"});
}

TEST(ParticleParts, ThatAreEmptyAreRefused) {
  const World world;
  PartSettings part;
  part.component = 1;
  test::expect_bad_input([&] { world.parts.particles(part, "supports[0]"); },
                         {"no particle is in the part of supports[0]", "; choose one that"});
  test::expect_bad_input([&] { world.parts.faces(part, "loads[2]"); },
                         {"no face of the surface is in the part of loads[2]"});
  part = {};
  part.ids = std::vector<double>{1e9};
  test::expect_bad_input([&] { world.parts.particles(part, ""); },
                         {"there is no particle 1000000000"});
  part.ids = std::vector<double>{0.5};
  test::expect_bad_input([&] { world.parts.particles(part, ""); }, {"there is no particle 0.5"});
  part = {};
  part.bone = "tail";
  test::expect_bad_input([&] { world.parts.particles(part, "probes[0]"); }, {"no bone 'tail'"});
  const Triangles none;
  const ParticleParts bare(world.settings, world.body, none, {});
  part = {};
  part.facing = Vec3(0, 0, 1);
  test::expect_bad_input([&] { bare.particles(part, ""); }, {"a surface without a mesh"});
}

/// Each load and probe keeps what it acts on: thousands on the whole body are refused before they
/// fill the memory, and as many on parts of their own are not.
TEST(ParticleParts, OnWhichThousandsActAreRefused) {
  World world;
  sinew::World machine;
  LoadSettings load;
  load.name = "all around";
  load.pressure = 100;
  ProbeSettings probe;
  probe.name = "all";
  world.settings.loads.assign(10000, load);
  world.settings.probes.assign(10000, probe);
  const auto add = [&] { add_machine(world.settings, world.body, world.parts, machine); };
  test::expect_bad_input(add,
                         {"the loads up to this one", "over 64 times as many", "; give those"});
  EXPECT_LT(machine.loads.size(), 1000U);
  test::expect_bad_input([&] { probes_of(world.settings, world.body, world.parts); },
                         {"the probes up to this one"});
  load.part.ids = std::vector<double>{3};
  world.settings.loads.assign(10000, load);
  for (LoadSettings& one : world.settings.loads) {
    one.pressure.reset();
    one.force = Vec3::UnitX();
  }
  machine = {};
  EXPECT_NO_THROW(add());
}

}  // namespace sinew::particle_parts_test
