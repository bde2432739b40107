// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/report/playback.h>

#include <sinew/metrics/report/comparison_page.h>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "metrics/world.h"

namespace sinew::test::playback_test {

Playback whole_playback(const RestBody& body, std::size_t frames) {
  Playback playback = plan_playback(body, frames);
  for (std::size_t i = 0; i < frames; ++i) {
    FrameState state = moved_rigidly(body, Mat3::Identity(), Vec3(0.01 * double(i), 0, 0));
    state.time = 0.1 * double(i);
    if (playback.wants(i)) add_frame(playback, i, body, state, particle_values(body, state));
  }
  return playback;
}

TEST(Playback, KeepsAllOfASmallRun) {
  const RestBody body = rest_body(box_input());
  const Playback playback = whole_playback(body, 4);
  EXPECT_EQ(playback.frames.size(), 4u);
  EXPECT_EQ(playback.particles.size(), body.particles());
  EXPECT_EQ(playback.points.size(), body.surface.points.size());
  EXPECT_EQ(playback.faces, body.surface.faces);
}

TEST(Playback, ThinsALongRunEvenlyAndKeepsItsEnds) {
  const Playback playback = plan_playback(rest_body(box_input()), 5000);
  EXPECT_EQ(playback.wanted.size(), 112u);  // 120 with the worst ones
  EXPECT_EQ(playback.wanted.front(), 0u);
  EXPECT_EQ(playback.wanted.back(), 4999u);
}

TEST(Playback, ThinsALargeBodyToAPageOfTenMegabytes) {
  RestInput input = box_input();
  input.positions = fcc_box(81, 41);
  input.bone.assign(input.positions.size(), 0);
  const RestBody body = rest_body(input);
  Playback playback = whole_playback(body, 100);
  const FrameState state = at_rest(body);
  const ParticleValues values = particle_values(body, state);
  for (std::size_t frame = 0, more = 8; more > 0; ++frame)  // as many worst frames as may come
    if (!playback.has(frame)) add_frame(playback, frame, body, state, values), --more;
  EXPECT_LT(playback.particles.size(), body.particles() / 2);
  // What a cut shows covers the area of its layer, and the others have the volume of all others.
  ASSERT_EQ(playback.balls.size(), 2u);
  const auto [layer, others] = std::pair(playback.balls[0], playback.balls[1]);
  EXPECT_EQ(layer.count + others.count, playback.particles.size());
  const auto end_of_layer = playback.particles.begin() + static_cast<std::ptrdiff_t>(layer.count);
  EXPECT_TRUE(std::is_sorted(playback.particles.begin(), end_of_layer));
  EXPECT_TRUE(std::is_sorted(end_of_layer, playback.particles.end()));
  const Box box = bounds(body.shape.points);
  const int axis = box.sizes().y() <= 1.01 * box.sizes().x() ? 1 : 0;
  const auto is_in_layer = [&](std::size_t i) {
    const double behind = (axis == 1 ? 1 : -1) * (body.shape.points[i][axis] - box.center()[axis]);
    return behind >= 0 && behind <= 2.5 * r;
  };
  EXPECT_TRUE(std::all_of(playback.particles.begin(), end_of_layer, is_in_layer));
  EXPECT_TRUE(std::none_of(end_of_layer, playback.particles.end(), is_in_layer));
  std::size_t beside = 0;
  for (std::size_t i = 0; i < body.particles(); ++i) beside += !is_in_layer(i);
  EXPECT_NEAR(static_cast<double>(layer.count) * std::pow(layer.radius / r, 2),
              static_cast<double>(body.particles() - beside), 1e-6);
  EXPECT_NEAR(static_cast<double>(others.count) * std::pow(others.radius / r, 3),
              static_cast<double>(beside), 1e-6);
  EXPECT_LT(playback_json(playback).size(), 8u << 20);
}

TEST(Playback, TakesAsManyBytesAsItMay) {
  RestInput input = box_input();
  input.positions = fcc_box(81, 41);
  input.bone.assign(input.positions.size(), 0);
  input.surface = sheet(400, 1.0 / 400);
  const RestBody body = rest_body(input);
  const Playback playback = plan_playback(body, 100, 0.5);
  const std::size_t snapshots = playback.wanted.size() + 8, each = 6 + playback_fields().size();
  EXPECT_EQ(playback.particles.size(), 1'900'000 / (each * snapshots));
  const ThinSurface thin = thin_surface(body.surface, 600'000 / (6 * snapshots));
  EXPECT_EQ(playback.points, thin.points);
  EXPECT_EQ(playback.faces, thin.faces);
}

TEST(Playback, TakesAWorstFrameInItsPlace) {
  const RestBody body = rest_body(box_input());
  Playback playback = plan_playback(body, 5000);
  FrameState state = at_rest(body);
  for (const std::size_t frame : {0, 4999, 17})
    add_frame(playback, frame, body, state, particle_values(body, state));
  EXPECT_TRUE(playback.has(17));
  EXPECT_FALSE(playback.has(18));
  EXPECT_EQ(playback.frames[1].frame, 17u);
}

TEST(Playback, IsWrittenWithPlacesAndValuesOfEveryFrame) {
  const RestBody body = rest_body(box_input());
  const auto json = nlohmann::json::parse(playback_json(whole_playback(body, 3)));
  const std::size_t n = body.particles();
  EXPECT_EQ(json["particles"].get<std::string>().size(), (3 * n * 3 * 2 + 2) / 3 * 4);
  EXPECT_EQ(json["snapshots"].size(), 3u);
  EXPECT_EQ(json["boneNames"], (std::vector<std::string>{"lower", "upper"}));
  EXPECT_EQ(json["boneColor"], (std::vector<int>{0, 1}));
  for (const auto& field : json["fields"]) {
    EXPECT_EQ(field["levels"].get<std::string>().size(), (3 * n + 2) / 3 * 4) << field["name"];
    EXPECT_LE(field["low"], field["high"]) << field["name"];
  }
  EXPECT_NEAR(json["fields"][0]["high"].get<double>(), 0.02, 1e-6);  // the displacement
}

TEST(Playback, FarFromTheOriginIsAsAtIt) {
  const auto shown = [](const Vec3& at) {
    const RestBody body = rest_body(moved_to(at, box_input()));
    Playback playback = whole_playback(body, 3);
    const Box all = box_of(playback);
    add_obstacles(playback, 1, Box(all.min() - all.sizes(), all.max() + all.sizes()), body.surface);
    return playback;
  };
  const Playback near = shown(Vec3::Zero());
  for (const double far : {0x1p10, 0x1p17, 0x1p23}) {
    const Vec3 at(far * 2 * half_length, 0, 0);
    const Playback there = shown(at);
    EXPECT_LT((box_of(there).min() - at - box_of(near).min()).norm(), 1e-7 + 1e-9 * far * r);
    const Vec3 shift = at - there.origin;
    for (std::size_t k = 0; k < 3; ++k)
      for (const auto places : {&PlaybackFrame::particles, &PlaybackFrame::surface,
                                &PlaybackFrame::bones, &PlaybackFrame::obstacles}) {
        const std::vector<float>&found = there.frames[k].*places, &all = near.frames[k].*places;
        ASSERT_EQ(found.size(), all.size());
        for (std::size_t i = 0; i < all.size(); ++i)
          EXPECT_NEAR(found[i], all[i] + shift[static_cast<int>(i % 3)], 1e-6 * half_length) << far;
      }
    EXPECT_LT(box_of(side_by_side(near, there, {"a: ", "b: "})).sizes().maxCoeff(),
              3 * box_of(near).sizes().maxCoeff());
  }
}

TEST(Playback, WritesTheForcesOfSupportsAndLoads) {
  const RestBody body = rest_body(box_input());
  Playback playback = whole_playback(body, 2);
  playback.is_load = {false, true};
  for (PlaybackFrame& frame : playback.frames) frame.forces = {0, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0};
  EXPECT_EQ(box_of(playback).max().z(), 1);
  const auto json = nlohmann::json::parse(playback_json(playback));
  EXPECT_EQ(json["isLoad"], (std::vector<bool>{false, true}));
  EXPECT_EQ(json["forces"].get<std::string>().size(), 64u);  // 2 frames of 12 numbers of 2 bytes
  const Playback both = side_by_side(playback, playback, {"a: ", "b: "});
  EXPECT_EQ(both.is_load, (std::vector<bool>{false, true, false, true}));
  EXPECT_EQ(both.frames[0].forces.size(), 24u);
}

TEST(Playback, WithoutBonesHasNoFieldOfThem) {
  RestInput input = box_input();
  input.skeleton.bones.clear();
  input.bone.assign(input.positions.size(), -1);
  const RestBody body = rest_body(input);
  for (const auto& field :
       nlohmann::json::parse(playback_json(whole_playback(body, 2)))["fields"]) {
    EXPECT_NE(field["name"], "weight of its bone");
    EXPECT_NE(field["name"], "distance to rigid pose");
  }
}

TEST(Playback, NamesTheMaterialsOfBothRuns) {
  const RestBody body = rest_body(box_input());
  Playback one = whole_playback(body, 1), other = one;
  EXPECT_TRUE(nlohmann::json::parse(playback_json(one))["materialNames"].empty());
  one.material_names = {"the rest", "fat"};
  one.material.assign(one.particles.size(), 1);
  other.material_names = {"the rest", "bone", "fat"};
  other.material.assign(other.particles.size(), 2);
  other.material[0] = 1;
  const Playback both = side_by_side(one, other, {"a: ", "b: "});
  EXPECT_EQ(both.material_names, (std::vector<std::string>{"the rest", "fat", "bone"}));
  const std::size_t n = one.particles.size();
  EXPECT_EQ(both.material[n - 1], 1);
  EXPECT_EQ(both.material[n], 2);
  EXPECT_EQ(both.material[n + 1], 1);
  const Playback half = side_by_side(whole_playback(body, 1), one, {"a: ", "b: "});
  EXPECT_EQ(half.material[0], 0);
  EXPECT_EQ(half.material[n], 1);
  EXPECT_EQ(nlohmann::json::parse(playback_json(half))["materialNames"].size(), 2u);
}

TEST(Playback, HasABoxAroundAllOfIt) {
  Playback playback;
  EXPECT_TRUE(box_of(playback).isEmpty());
  playback.frames.push_back({0, 0, {1, 2, 3, -1, 5, 0}, {0, 0, 7}, {4, 0, 0, 0, -2, 0}, {}});
  playback.frames.push_back({1, 0.1, {0, 0, -3}, {}, {}, {}});
  EXPECT_EQ(box_of(playback).min(), Vec3(-1, -2, -3));
  EXPECT_EQ(box_of(playback).max(), Vec3(4, 5, 7));
}

TEST(Playback, DrawsBonesAsLongAsTheyAre) {
  const RestBody body = rest_body(box_input());
  FrameState state = at_rest(body);
  for (const Bone& bone : body.bones) state.bone_lengths.push_back(2 * bone.length);
  Playback playback = plan_playback(body, 1);
  add_frame(playback, 0, body, state, particle_values(body, state));
  const std::vector<float>& ends = playback.frames[0].bones;  // head and tail of each
  const double length = Vec3(ends[3] - ends[0], ends[4] - ends[1], ends[5] - ends[2]).norm();
  EXPECT_NEAR(length, 2 * body.bones[0].length, 1e-6);
}

TEST(Playback, LeavesOutWhatWasNotMeasured) {
  const auto json = nlohmann::json::parse(playback_json(whole_playback(rest_body(box_input()), 1)));
  for (const auto& field : json["fields"]) EXPECT_NE(field["name"], "von Mises stress");
}

TEST(ThinSurface, KeepsAllThatIsNotTooMuch) {
  const Triangles square = sheet(40, 1.0 / 40);
  const std::size_t all = square.points.size();
  EXPECT_EQ(thin_surface(square, all).faces, square.faces);
  EXPECT_LT(thin_surface(square, all - 1).points.size(), all);
}

TEST(ThinSurface, KeepsShapeWithFewerPoints) {
  const Triangles grid = sheet(40, 1.0 / 40);
  const ThinSurface thin = thin_surface(grid, 200);
  EXPECT_LE(thin.points.size(), 200u);
  EXPECT_GE(thin.points.size(), 80u);
  Triangles coarse{{}, thin.faces};
  for (const auto i : thin.points) coarse.points.push_back(grid.points[i]);
  EXPECT_NEAR(area(coarse), 1, 0.2);
  for (const auto& [a, b, c] : thin.faces) EXPECT_TRUE(a != b && b != c && c != a);
}

TEST(Playback, CutsObstaclesToTheirSpace) {
  const Triangles square{{{-9, -9, 0.5}, {9, -9, 0.5}, {9, 9, 0.5}, {-9, 9, 0.5}},
                         {{0, 1, 2}, {0, 2, 3}}};
  const Box space(Vec3(-1, -2, 0), Vec3(2, 2, 1));
  const auto area_of = [&](const Triangles& surface) {
    const Points corners = cut_to(space, surface);
    double sum = 0;
    for (std::size_t i = 0; i < corners.size(); i += 3) {
      sum += (corners[i + 1] - corners[i]).cross(corners[i + 2] - corners[i]).z() / 2;
      for (std::size_t k = i; k < i + 3; ++k) EXPECT_LE(space.exteriorDistance(corners[k]), 1e-12);
    }
    return sum;
  };
  EXPECT_NEAR(area_of(square), 12, 1e-12);
  EXPECT_EQ(area_of({{{0, 0, 0.5}, {1, 0, 0.5}, {0, 1, 0.5}}, {{0, 1, 2}}}), 0.5);
  EXPECT_EQ(area_of({{{3, 0, 0.5}, {4, 0, 0.5}, {3, 1, 0.5}}, {{0, 1, 2}}}), 0);
}

TEST(Playback, WritesObstaclesOnceWhileTheyStandStill) {
  const RestBody body = rest_body(box_input());
  Playback playback = whole_playback(body, 3);
  playback.held = {0, 2};
  const Triangles one{{{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}}, {{0, 1, 2}}};
  Triangles moved = one;
  for (Vec3& point : moved.points) point.z() += 0.01;
  const Box space(Vec3::Constant(-1), Vec3::Constant(1));
  for (const std::size_t frame : {0, 1}) add_obstacles(playback, frame, space, one);
  add_obstacles(playback, 2, space, moved);
  const auto json = nlohmann::json::parse(playback_json(playback));
  EXPECT_EQ(json["obstacles"][0].get<std::string>().size(), 24U);  // 9 numbers of 2 bytes
  EXPECT_TRUE(json["obstacles"][1].is_null());
  EXPECT_TRUE(json["obstacles"][2].is_string());
  EXPECT_EQ(json["held"], "AAAAAAIAAAA=");
  const Playback both = side_by_side(playback, playback, {"a: ", "b: "});
  EXPECT_EQ(both.held.size(), 4U);
  EXPECT_EQ(both.held[3], 2 + playback.particles.size());
  EXPECT_EQ(both.frames[0].obstacles.size(), 18U);
  EXPECT_GT(both.frames[0].obstacles[9], playback.frames[0].obstacles[0]);  // beside
}

}  // namespace sinew::test::playback_test
