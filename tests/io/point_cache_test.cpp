// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/point_cache.h>

#include <gtest/gtest.h>

#include <bit>
#include <cstring>

#include "support/scratch.h"

namespace sinew::point_cache_test {

using PointCacheFile = Scratch;

std::uint32_t word_at(const std::string& bytes, std::size_t place) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i)
    word |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes.at(place + i))) << (8 * i);
  return word;
}

float number_at(const std::string& bytes, std::size_t place) {
  return std::bit_cast<float>(word_at(bytes, place));
}

TEST_F(PointCacheFile, ReadsBackAsWritten) {
  const auto path = folder / "surface.pc2";
  const Points samples[] = {
      {{1, 2, 3}, {-4, 0.1, 1e-3}}, {{5, 6, 7}, {0, 0, 0}}, {{8, 9, 1}, {2, 3, 4}}};
  PointCache cache(path, 2);
  for (const Points& points : samples) cache.add(points);
  cache.close();
  const std::string bytes = read_file(path);
  ASSERT_EQ(bytes.size(), 32 + 3 * 2 * 12u);
  EXPECT_EQ(bytes.substr(0, 12), std::string("POINTCACHE2\0", 12));
  EXPECT_EQ(word_at(bytes, 12), 1u);
  EXPECT_EQ(word_at(bytes, 16), 2u);
  EXPECT_EQ(number_at(bytes, 20), 0.f);
  EXPECT_EQ(number_at(bytes, 24), 1.f);
  EXPECT_EQ(word_at(bytes, 28), 3u);
  std::size_t place = 32;
  for (const Points& points : samples)
    for (const Vec3& point : points)
      for (const double coordinate : point) {
        EXPECT_EQ(number_at(bytes, place), static_cast<float>(coordinate));
        place += 4;
      }
}

TEST_F(PointCacheFile, CountsAtAnyMomentTheSamplesItHolds) {
  PointCache cache(folder / "surface.pc2", 1);
  for (std::uint32_t samples = 0; samples < 3; ++samples) {
    const std::string bytes = read_file(folder / "surface.pc2");
    EXPECT_EQ(word_at(bytes, 28), samples);
    EXPECT_EQ(bytes.size(), 32 + 12 * samples);
    cache.add({{1, 2, 3}});
  }
}

TEST_F(PointCacheFile, GoesOnAfterTheSamplesThatAreKept) {
  const auto write = [&](const char* name, std::size_t kept, std::initializer_list<double> all) {
    PointCache cache(folder / name, 1, kept);
    for (const double x : all) cache.add({{x, 0, 0}});
  };
  write("whole.pc2", 0, {1, 2, 3});
  write("surface.pc2", 0, {1, 7});
  put(folder / "surface.pc2", text_of(folder / "surface.pc2") + "torn");
  write("surface.pc2", 1, {2, 3});
  EXPECT_EQ(text_of(folder / "surface.pc2"), text_of(folder / "whole.pc2"));
  const Error error = error_of([&] { PointCache(folder / "surface.pc2", 1, 4); });
  EXPECT_EQ(error.exit(), Exit::bad_input);
  EXPECT_TRUE(contains(error.what(), "68 bytes where 80")) << error.what();
}

TEST_F(PointCacheFile, HoldsPointsAndFacesInOrder) {
  const auto path = folder / "surface.obj";
  write_obj(path, {{{0, 0, 0}, {1, 0, 0.1}, {0, 1, 0}}, {{0, 1, 2}}});
  EXPECT_EQ(read_file(path), "# surface at rest, m\nv 0 0 0\nv 1 0 0.1\nv 0 1 0\nf 1 2 3\n");
}

TEST_F(PointCacheFile, NamesPartsAndTextureCoordinatesOfFaces) {
  const Triangles surface = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}},
                             {{0, 1, 2}, {1, 3, 2}, {0, 1, 3}}};
  SurfaceLook look{{{0, 0.5}, {1, 0}, {0.25, 1}},
                   {{0, 1, 2}, {-1, -1, -1}, {2, 1, 0}},
                   {0, -1, 1},
                   {{"arm", "skin", "red"}, {"arm", "nail", "red"}},
                   {"../a.mtl"}};
  write_obj(folder / "surface.obj", surface, look);
  const std::string text = read_file(folder / "surface.obj");
  EXPECT_TRUE(contains(text, "m\nmtllib ../a.mtl\nv 0 0 0\n"));
  EXPECT_EQ(text.substr(text.find("vt")),
            "vt 0 0.5\nvt 1 0\nvt 0.25 1\no arm\ng skin\nusemtl red\nf 1/1 2/2 3/3\n"
            "f 2 4 3\ng nail\nf 1/3 2/2 4/1\n");
}

}  // namespace sinew::point_cache_test
