// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/single_files.h>

#include <sinew/io/vtu.h>
#include "support/scratch.h"
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

TEST_F(Body, ComesBackWithWhatItsPartsHaveOfTheirOwn) {
  BodyFile written = SyntheticRun().body();
  const std::size_t n = written.particles.size();
  written.stiffness = std::vector<double>(n, 1.0 / 3);
  written.density = std::vector<double>(n, 0.1);
  written.volume_stiffness = std::vector<double>(n, 1e4 / 7);
  write_body(folder / "body.vtu", written);
  const BodyFile read = read_body(folder / "body.vtu");
  EXPECT_EQ(read.particles.mass, written.particles.mass);
  EXPECT_EQ(read.stiffness, written.stiffness);
  EXPECT_EQ(read.density, written.density);
  EXPECT_EQ(read.volume_stiffness, written.volume_stiffness);
  const Dataset data = body_dataset(written);
  for (const Column& column : data.point_columns)
    if (column.name == "mass") {
      EXPECT_EQ(std::get<1>(column.values)[0], 0.1 * written.particles.mass);
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
  const auto numbers_in = [](Dataset& data, std::string_view name) -> std::vector<double>& {
    for (Column& column : data.point_columns)
      if (column.name == name) return std::get<1>(column.values);
    throw std::out_of_range(std::string(name));
  };
  const auto without_component = [](Dataset& d) {
    std::erase_if(d.point_columns, [](const Column& one) { return one.name == "component"; });
  };
  EXPECT_TRUE(contains(message(without_component), "component"));
  EXPECT_TRUE(
      contains(message([](Dataset& d) { std::get<0>(d.point_columns[0].values)[3] = 4; }), "ids"));
  EXPECT_TRUE(contains(message([&](Dataset& d) { numbers_in(d, "radius")[3] = 1; }), "radius"));
  EXPECT_TRUE(contains(message([&](Dataset& d) { numbers_in(d, "mass")[0] = 0; }), "mass"));
  for (const std::string name : {"share", "weight"})
    EXPECT_TRUE(contains(message([&](Dataset& d) { numbers_in(d, name)[2] = NAN; }), name)) << name;
  EXPECT_TRUE(contains(message([](Dataset& d) { d.points[2].x() = NAN; }), "finite"));
  EXPECT_TRUE(contains(message([](Dataset& d) { d = {}; }), "no particles"));
}

}  // namespace sinew::body_test
