// SPDX-License-Identifier: GPL-3.0-or-later
// Frames in whose file several processes write their part of the particles are read as any other.
#include <sinew/core/file.h>
#include <sinew/io/series.h>
#include <sinew/io/vtu.h>
#include "support/expect_error.h"
#include "support/scratch.h"

namespace sinew::vtu_pieces_test {

const VtuFormat format{.series = "particles", .radius = 0.01};

Dataset particles(const std::vector<std::int32_t>& ids) {
  Dataset data;
  data.time = 0.25;
  data.cycle = 7;
  std::vector<double> speeds;
  for (const std::int32_t id : ids) {
    data.points.emplace_back(id, 2 * id, -id);
    speeds.insert(speeds.end(), {0.5 * id, 0, 1});
  }
  data.connectivity = vertex_cells(ids.size());
  data.point_columns = {column("id", ids), column("velocity", speeds)};
  data.point_columns.back().components = 3;
  data.field_columns = {column("kinetic_energy", std::vector<double>{1.5})};
  return data;
}

class Pieces : public Scratch {
 protected:
  void write(const std::vector<Dataset>& pieces, const VtuFormat& how = format) {
    Series series(folder, how);
    file = folder / frame_name("particles", 0);
    std::vector<std::string> parts{vtu_beginning(how)};
    std::vector<std::uint64_t> places{0};
    for (const Dataset& piece : pieces) {
      places.push_back(places.back() + parts.back().size());
      parts.push_back(vtu_piece(piece, how));
    }
    write_part(file, 0, parts[0]);
    for (std::size_t k = parts.size(); k-- > 1;) write_part(file, places[k], parts[k]);
    EXPECT_FALSE(std::filesystem::exists(file));
    series.finish(particles({}));
    series.close();
    EXPECT_EQ(read_pvd(folder / "particles.pvd").size(), 1u);
  }
  std::filesystem::path file;
};

TEST_F(Pieces, AreReadAsOne) {
  for (const Encoding encoding : {Encoding::zlib, Encoding::lz4, Encoding::none}) {
    VtuFormat how = format;
    how.encoding = encoding;
    write({particles({0, 1}), particles({2}), particles({3, 4})}, how);
    const Dataset found = read_vtu(file), expected = particles({0, 1, 2, 3, 4});
    EXPECT_EQ(found.points, expected.points);
    EXPECT_EQ(found.connectivity, expected.connectivity);
    EXPECT_EQ(integers(found.point_columns, "id"), integers(expected.point_columns, "id"));
    EXPECT_EQ(vectors(found.point_columns, "velocity"),
              vectors(expected.point_columns, "velocity"));
    EXPECT_EQ(numbers(found.field_columns, "kinetic_energy"), std::vector<double>{1.5});
    EXPECT_EQ(found.time, 0.25);
    EXPECT_EQ(found.cycle, 7);
    EXPECT_EQ(read_vtu(file, {"velocity"}).point_columns.size(), 1u);
  }
}

TEST_F(Pieces, AreReplacedWhole) {
  write({particles({0, 1}), particles({2, 3, 4})});
  write_part(file, 0, std::string(100000, '-'));  // what a process left that was killed
  write({particles({0})});
  EXPECT_EQ(read_vtu(file).points.size(), 1u);
}

TEST_F(Pieces, HaveTheSameArrays) {
  Dataset other = particles({2});
  other.point_columns.pop_back();
  write({particles({0, 1}), other});
  test::expect_bad_input([&] { read_vtu(file); }, {"particles_000000.vtu", "same arrays"});
  other.point_columns.push_back(column("velocity", std::vector<double>{1}));
  write({particles({0, 1}), other});
  test::expect_bad_input([&] { read_vtu(file); }, {"same arrays"});
}

TEST_F(Pieces, AreOfParticles) {
  Dataset line = particles({2, 3});
  line.kind = CellKind::line;
  write({particles({0, 1}), line});
  test::expect_bad_input([&] { read_vtu(file); }, {"more than vertices"});
}

TEST_F(Pieces, ThatAreNotThereAreNamed) {
  Series series(folder, format);
  test::expect_error(Exit::not_written, [&] { series.finish(particles({})); },
                     {"particles_000000.vtu"});
}

}  // namespace sinew::vtu_pieces_test
