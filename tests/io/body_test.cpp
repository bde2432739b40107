// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/single_files.h>

#include <sinew/io/vtu.h>
#include "scratch.h"
#include "synthetic_run.h"

namespace sinew::body_test {

using Body = Scratch;

TEST_F(Body, ComesBackBitForBit) {
  const BodyFile written = SyntheticRun().body();
  for (const Encoding encoding : {Encoding::zlib, Encoding::raw}) {
    write_body(folder / "body.vtu", written, encoding);
    const BodyFile read = read_body(folder / "body.vtu");
    EXPECT_EQ(state_hash(read.particles), state_hash(written.particles));
    EXPECT_EQ(read.particles.radius, written.particles.radius);
    EXPECT_EQ(read.particles.mass, written.particles.mass);
    EXPECT_EQ(read.neighbors, written.neighbors);
    EXPECT_EQ(read.component, written.component);
    EXPECT_EQ(read.bone, written.bone);
    EXPECT_EQ(read.meta, written.meta);
  }
}

TEST_F(Body, NeedsNoBones) {
  BodyFile written = SyntheticRun().body();
  written.bone.reset();
  write_body(folder / "body.vtu", written);
  EXPECT_FALSE(read_body(folder / "body.vtu").bone);
}

TEST_F(Body, IsRefusedWhenAnArrayIsMissingOrWrong) {
  const Dataset good = body_dataset(SyntheticRun().body());
  const auto message = [&](auto&& damage) {
    Dataset data = good;
    damage(data);
    write_vtu(folder / "body.vtu", data, {Encoding::zlib, false, "body", 0.01});
    const Error error = error_of([&] { read_body(folder / "body.vtu"); });
    EXPECT_EQ(error.exit(), Exit::bad_input);
    EXPECT_TRUE(contains(error.what(), "body.vtu: ")) << error.what();
    return std::string(error.what());
  };
  const auto& numbers_in = [](Dataset& data, int k) -> std::vector<double>& {
    return std::get<1>(data.point_columns[k].values);
  };
  EXPECT_TRUE(contains(
      message([](Dataset& d) { d.point_columns.erase(d.point_columns.end() - 3); }), "component"));
  EXPECT_TRUE(
      contains(message([](Dataset& d) { std::get<0>(d.point_columns[0].values)[3] = 4; }), "ids"));
  EXPECT_TRUE(contains(message([&](Dataset& d) { numbers_in(d, 1)[3] = 1; }), "radius"));
  EXPECT_TRUE(contains(message([&](Dataset& d) { numbers_in(d, 2)[0] = 0; }), "mass"));
  EXPECT_TRUE(contains(
      message([&](Dataset& d) { numbers_in(d, int(d.point_columns.size()) - 1)[2] = NAN; }),
      "weight"));
  EXPECT_TRUE(contains(message([](Dataset& d) { d.points[2].x() = NAN; }), "finite"));
  EXPECT_TRUE(contains(message([](Dataset& d) { d = {}; }), "no particles"));
}

}  // namespace sinew::body_test
