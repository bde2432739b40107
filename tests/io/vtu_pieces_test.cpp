// SPDX-License-Identifier: GPL-3.0-or-later
// Frames whose particles are in several files are read as one, in the order of their ids.
#include <sinew/core/file.h>
#include <sinew/io/series.h>
#include <sinew/io/vtu.h>
#include "expect_error.h"
#include "scratch.h"

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
  void write(const std::vector<std::vector<std::int32_t>>& ids) {
    Series series(folder, format);
    std::vector<std::int32_t> all;
    for (std::size_t k = 0; k < ids.size(); ++k) {
      Dataset piece = particles(ids[k]);
      piece.field_columns.clear();
      write_vtu(folder / "particles" / piece_of_frame("particles", 0, static_cast<int>(k)), piece,
                format);
      all.insert(all.end(), ids[k].begin(), ids[k].end());
    }
    series.add_pieced(particles(all), static_cast<int>(ids.size()));
    series.close();
    file = folder / read_pvd(folder / "particles.pvd").front().file;
  }
  std::filesystem::path file;
};

TEST_F(Pieces, AreReadAsOneInTheOrderOfIds) {
  write({{4, 1}, {}, {0, 2, 3}});
  EXPECT_EQ(file.filename(), "particles_000000.pvtu");
  const Dataset found = read_vtu(file), expected = particles({0, 1, 2, 3, 4});
  EXPECT_EQ(found.points, expected.points);
  EXPECT_EQ(found.connectivity, expected.connectivity);
  EXPECT_EQ(integers(found.point_columns, "id"), integers(expected.point_columns, "id"));
  EXPECT_EQ(vectors(found.point_columns, "velocity"), vectors(expected.point_columns, "velocity"));
  EXPECT_EQ(numbers(found.field_columns, "kinetic_energy"), std::vector<double>{1.5});
  EXPECT_EQ(found.time, 0.25);
  EXPECT_EQ(found.cycle, 7);
}

TEST_F(Pieces, AreSortedAlsoWhereIdsAreNotAskedFor) {
  write({{2, 0}, {1}});
  const Dataset found = read_vtu(file, {"velocity"});
  ASSERT_EQ(found.point_columns.size(), 1u);
  EXPECT_EQ(vectors(found.point_columns, "velocity")[1].x(), 0.5);
}

TEST_F(Pieces, ThatDoNotMakeOneBodyAreRefused) {
  write({{0, 1}, {1}});
  test::expect_bad_input([&] { read_vtu(file); }, {"particle 1", "twice"});
  std::filesystem::remove(folder / "particles" / piece_of_frame("particles", 0, 1));
  test::expect_bad_input([&] { read_vtu(file); }, {"particles_000000.1.vtu"});
}

TEST_F(Pieces, LieBesideTheFileThatNamesThem) {
  write({{0}, {1}});
  std::string text = read_file(file);
  const std::string name = piece_of_frame("particles", 0, 1);
  write_file(file, text.replace(text.find(name), name.size(), "../" + name));
  test::expect_bad_input([&] { read_vtu(file); }, {"beside"});
}

TEST_F(Pieces, StayWithTheirFrameAndGoWithIt) {
  write({{0}, {1}});
  const auto piece = folder / "particles" / piece_of_frame("particles", 0, 1);
  {
    const std::vector<double> kept{0.25};
    const Series series(folder, format, kept);
    EXPECT_EQ(series.rows().front().file, "particles/particles_000000.pvtu");
    EXPECT_EQ(series.pieces().size(), 3u);  // the last one has no points
    EXPECT_TRUE(std::filesystem::exists(piece));
  }
  const Series series(folder, format);
  EXPECT_FALSE(std::filesystem::exists(piece));
  EXPECT_FALSE(std::filesystem::exists(file));
}

}  // namespace sinew::vtu_pieces_test
