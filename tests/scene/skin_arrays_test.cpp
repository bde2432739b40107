// SPDX-License-Identifier: GPL-3.0-or-later
// The arrays of particles that the surface of a frame has.
#include <gtest/gtest.h>

#include <cmath>

#include <sinew/metrics/particle_values.h>
#include <sinew/rig/skin.h>
#include <sinew/run/frame_data.h>
#include <sinew/scene/frame_content.h>
#include <sinew/scene/prepare.h>

#include "mesh/shapes.h"
#include "support/expect_error.h"
#include "support/world.h"

namespace sinew::skin_arrays_test {

/// A bar that bends.
Scene bending_bar(MaterialModel model, const std::string& skin) {
  Settings scene;
  scene.body.mesh = "bar";
  scene.meshes["bar"] = shapes::box({-0.05, -0.05, 0}, {0.05, 0.05, 0.3});
  scene.body.radius = 0.013;
  scene.material.model = model;
  scene.bones = {{"lower", "", Vec3(0, 0, 0), Vec3(0, 0, 0.15)},
                 {"upper", "lower", {}, Vec3(0, 0, 0.3)}};
  const std::array times{0.0, 0.05};
  const std::array turns{Quat::Identity(), Quat(Eigen::AngleAxisd(0.3, Vec3::UnitY()))};
  scene.tracks = {track_of("upper", times, turns)};
  scene.output.skin = skin;
  scene.solver.duration = 0.05;
  return {scene};
}

struct Moment {
  Prepared prepared;
  Simulation simulation;
  FrameData frame;

  explicit Moment(const Scene& scene)
      : prepared(prepare(scene)), simulation(start(Prepared(prepared))), frame(prepared) {
    simulation.advance(50);
    frame.take(simulation);
  }
};

std::vector<std::string> names_in(const Dataset& surface) {
  std::vector<std::string> names;
  for (const Column& column : surface.point_columns) names.push_back(column.name);
  return names;
}

TEST(SurfaceArrays, AreStrainAndOfBondedBodiesStress) {
  using Names = std::vector<std::string>;
  const auto names = [](MaterialModel model, const std::string& skin) {
    return names_in(Moment(bending_bar(model, skin)).frame.surface());
  };
  const Names own = {"displacement", "normal", "bone"};
  const auto with = [&](const Names& more) {
    Names all = own;
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  EXPECT_EQ(names(MaterialModel::paper, ""), with({"strain_eq"}));
  EXPECT_EQ(names(MaterialModel::bonded, ""), with({"strain_eq", "von_mises"}));
  EXPECT_EQ(names(MaterialModel::bonded, "none"), own);
  EXPECT_EQ(names(MaterialModel::paper, "none, force_twist velocity bone"),
            with({"velocity", "force_twist"}));
}

TEST(SurfaceArrays, OfLargeBodiesAreThoseThatAreAskedFor) {
  Body body;
  body.rest.resize(200'000, Vec3::Zero());
  const OutputSettings usual;
  EXPECT_EQ(content_of_skin(usual, body).usual.size(), 1U);
  body.rest.resize(200'001, Vec3::Zero());
  EXPECT_TRUE(content_of_skin(usual, body).usual.empty());
  OutputSettings asked;
  asked.skin = "strain_eq";
  EXPECT_EQ(content_of_skin(asked, body).named.requested.measured.size(), 1U);
}

/// Each array of the surface is the mean of the particles' own of the same moment, whether the
/// particles were asked for before or not.
TEST(SurfaceArrays, AreMeansOfTheParticlesOfTheSameMoment) {
  Moment moment(bending_bar(MaterialModel::bonded, "all"));
  const std::vector<Column> alone = moment.frame.surface().point_columns;
  const Prepared& prepared = moment.prepared;
  const Dataset particles = evaluated(moment.frame.particles());
  const std::vector<Column> after = moment.frame.surface().point_columns;
  const Skin skin =
      make_skin(prepared.surface.triangles.points, prepared.body.rest,
                prepared.body.material.pair.r, prepared.body.skeleton, prepared.body.binding);
  int compared = 0;
  for (const Column& array : alone) {
    const Column* again = find(after, array.name);
    ASSERT_TRUE(again) << array.name;
    if (array.name == "displacement") continue;  // its own
    const Column* of_particles = find(particles.point_columns, array.name);
    if (!of_particles) continue;
    const Column expected = at_vertices(skin, *of_particles);
    EXPECT_EQ(array.components, expected.components) << array.name;
    EXPECT_TRUE(array.values == expected.values && again->values == expected.values) << array.name;
    ++compared;
  }
  EXPECT_GT(compared, 10);
  EXPECT_GT(alone.size(), 25U);
}

TEST(SurfaceArrays, OfAnAffineMotionAreItsStrain) {
  const Prepared prepared = prepare(bending_bar(MaterialModel::bonded, ""));
  const ParticleMeter meter(prepared.body, prepared.surface.triangles);
  const Skin skin = make_skin(prepared.surface.triangles.points, prepared.body.rest,
                              prepared.body.material.pair.r);
  const Mat3 F = Vec3(1.1, 0.9, 1.2).asDiagonal();
  FrameState state = meter.at_rest();
  state.positions = test::affine(state.positions, F, Vec3(1, 2, 3));
  const std::array<std::string_view, 2> names = {"strain_eq", "strain"};
  const std::vector<Column> found = particle_arrays(meter.rest(), state, names);
  const Vec3 hencky = F.diagonal().array().log();
  const double expected = std::sqrt(2.0 / 3 * (hencky.array() - hencky.mean()).square().sum());
  const auto on_skin = [&](const Column& array) {
    return std::get<std::vector<double>>(at_vertices(skin, array).values);
  };
  for (const double value : on_skin(found[0])) EXPECT_NEAR(value, expected, 1e-9);
  const std::vector<double> tensor = on_skin(found[1]);
  for (std::size_t i = 0; i < tensor.size(); i += 6)
    EXPECT_NEAR(tensor[i + 2], (1.2 * 1.2 - 1) / 2, 1e-9);
}

TEST(SurfaceArrays, ThatABodyHasNotAreRefusedWithTheSetting) {
  Scene scene = bending_bar(MaterialModel::paper, "bone_point");
  scene.settings.bones.clear(), scene.settings.tracks.clear();
  SupportSettings foot;
  foot.name = "foot", foot.part.facing = Vec3(0, 0, -1);
  scene.settings.supports = {foot};
  test::expect_bad_input([&] { FrameData frame(prepare(scene)); },
                         {"output.skin", "bone_point", "none has a bone"});
}

}  // namespace sinew::skin_arrays_test
