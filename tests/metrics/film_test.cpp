// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/report/film.h>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <sinew/metrics/report/thin_surface.h>
#include "world.h"

namespace sinew::test {
namespace {

Film whole_film(const RestBody& body, std::size_t frames) {
  Film film = plan_film(body, frames);
  for (std::size_t i = 0; i < frames; ++i) {
    FrameState state = moved_rigidly(body, Mat3::Identity(), Vec3(0.01 * double(i), 0, 0));
    state.time = 0.1 * double(i);
    if (film.wants(i)) add_frame(film, i, body, state, particle_values(body, state));
  }
  return film;
}

TEST(Film, KeepsAllOfASmallRun) {
  const RestBody body = rest_body(box_input());
  const Film film = whole_film(body, 4);
  EXPECT_EQ(film.frames.size(), 4u);
  EXPECT_EQ(film.particles.size(), body.particles());
  EXPECT_EQ(film.points.size(), body.surface.points.size());
  EXPECT_EQ(film.faces, body.surface.faces);
}

TEST(Film, ThinsALongRunEvenlyAndKeepsItsEnds) {
  const Film film = plan_film(rest_body(box_input()), 5000);
  EXPECT_EQ(film.wanted.size(), 112u);  // 120 with the worst ones
  EXPECT_EQ(film.wanted.front(), 0u);
  EXPECT_EQ(film.wanted.back(), 4999u);
}

TEST(Film, ThinsALargeBodyToAPageOfTenMegabytes) {
  RestInput input = box_input();
  input.positions = fcc_box(81, 41);
  input.bone.assign(input.positions.size(), 0);
  const RestBody body = rest_body(input);
  Film film = whole_film(body, 100);
  const FrameState state = at_rest(body);
  const ParticleValues values = particle_values(body, state);
  for (std::size_t frame = 0, more = 8; more > 0; ++frame)  // as many worst frames as may come
    if (!film.has(frame)) add_frame(film, frame, body, state, values), --more;
  EXPECT_LT(film.particles.size(), body.particles() / 2);
  ASSERT_EQ(film.balls.size(), 1u);  // as much of them as of all particles
  EXPECT_EQ(film.balls[0].count, film.particles.size());
  EXPECT_NEAR(static_cast<double>(film.particles.size()) * std::pow(film.balls[0].radius / r, 3),
              static_cast<double>(body.particles()), 1e-6);
  EXPECT_TRUE(std::is_sorted(film.particles.begin(), film.particles.end()));
  EXPECT_LT(film_json(film).size(), 8u << 20);
}

TEST(Film, TakesAsManyBytesAsItMay) {
  RestInput input = box_input();
  input.positions = fcc_box(81, 41);
  input.bone.assign(input.positions.size(), 0);
  input.surface = sheet(400, 1.0 / 400);
  const RestBody body = rest_body(input);
  const Film film = plan_film(body, 100, 0.5);
  const std::size_t shots = film.wanted.size() + 8, each = 6 + film_fields().size();
  EXPECT_EQ(film.particles.size(), 1'900'000 / (each * shots));
  const ThinSurface thin = thin_surface(body.surface, 600'000 / (6 * shots));
  EXPECT_EQ(film.points, thin.points);
  EXPECT_EQ(film.faces, thin.faces);
}

TEST(Film, TakesAWorstFrameInItsPlace) {
  const RestBody body = rest_body(box_input());
  Film film = plan_film(body, 5000);
  FrameState state = at_rest(body);
  for (const std::size_t frame : {0, 4999, 17})
    add_frame(film, frame, body, state, particle_values(body, state));
  EXPECT_TRUE(film.has(17));
  EXPECT_FALSE(film.has(18));
  EXPECT_EQ(film.frames[1].frame, 17u);
}

TEST(Film, IsWrittenWithPlacesAndValuesOfEveryFrame) {
  const RestBody body = rest_body(box_input());
  const auto json = nlohmann::json::parse(film_json(whole_film(body, 3)));
  const std::size_t n = body.particles();
  EXPECT_EQ(json["particles"].get<std::string>().size(), (3 * n * 3 * 2 + 2) / 3 * 4);
  EXPECT_EQ(json["shots"].size(), 3u);
  EXPECT_EQ(json["boneNames"], (std::vector<std::string>{"lower", "upper"}));
  for (const auto& field : json["fields"]) {
    EXPECT_EQ(field["levels"].get<std::string>().size(), (3 * n + 2) / 3 * 4) << field["name"];
    EXPECT_LE(field["low"], field["high"]) << field["name"];
  }
  EXPECT_NEAR(json["fields"][0]["high"].get<double>(), 0.02, 1e-6);  // the displacement
}

TEST(Film, HasABoxAroundAllOfIt) {
  Film film;
  EXPECT_TRUE(box_of(film).isEmpty());
  film.frames.push_back({0, 0, {1, 2, 3, -1, 5, 0}, {0, 0, 7}, {4, 0, 0, 0, -2, 0}, {}});
  film.frames.push_back({1, 0.1, {0, 0, -3}, {}, {}, {}});
  EXPECT_EQ(box_of(film).min(), Vec3(-1, -2, -3));
  EXPECT_EQ(box_of(film).max(), Vec3(4, 5, 7));
}

TEST(Film, DrawsBonesAsLongAsTheyAre) {
  const RestBody body = rest_body(box_input());
  FrameState state = at_rest(body);
  for (const MeasuredBone& bone : body.bones) state.bone_lengths.push_back(2 * bone.length);
  Film film = plan_film(body, 1);
  add_frame(film, 0, body, state, particle_values(body, state));
  const std::vector<float>& ends = film.frames[0].bones;  // head and tail of each
  const double length = Vec3(ends[3] - ends[0], ends[4] - ends[1], ends[5] - ends[2]).norm();
  EXPECT_NEAR(length, 2 * body.bones[0].length, 1e-6);
}

TEST(Film, LeavesOutWhatWasNotMeasured) {
  const auto json = nlohmann::json::parse(film_json(whole_film(rest_body(box_input()), 1)));
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

}  // namespace
}  // namespace sinew::test
