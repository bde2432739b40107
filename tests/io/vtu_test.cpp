// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/vtu.h>

#include <sinew/core/arrays.h>
#include "support/scratch.h"
#include "synthetic_run.h"

namespace sinew::vtu_test {

using Vtu = Scratch;

/// Bitwise for integers, to the rounding of Float32 (or exact) for the rest.
void expect_equal(const std::vector<Column>& read, const std::vector<Column>& written,
                  double part) {
  ASSERT_EQ(read.size(), written.size());
  for (const Column& expected : written) {
    const Column* column = find(read, expected.name);
    ASSERT_TRUE(column) << expected.name;
    EXPECT_EQ(column->components, expected.components) << expected.name;
    ASSERT_EQ(column->values.index(), expected.values.index()) << expected.name;
    if (expected.values.index() == 0) {
      EXPECT_EQ(column->values, expected.values) << expected.name;
      continue;
    }
    const auto& is = std::get<1>(column->values);
    const auto& should = std::get<1>(expected.values);
    ASSERT_EQ(is.size(), should.size()) << expected.name;
    for (std::size_t i = 0; i < is.size(); ++i)
      EXPECT_NEAR(is[i], should[i], part * std::abs(should[i])) << expected.name;
  }
}

void expect_equal(const Dataset& read, const Dataset& written, double part) {
  EXPECT_EQ(read.time, written.time);
  EXPECT_EQ(read.cycle, written.cycle);
  EXPECT_EQ(read.meta, written.meta);
  EXPECT_EQ(read.kind, written.kind);
  EXPECT_EQ(read.connectivity, written.connectivity);
  expect_equal({column("Points", read.points)}, {column("Points", written.points)}, part);
  expect_equal(read.point_columns, written.point_columns, part);
  expect_equal(read.cell_columns, written.cell_columns, part);
  expect_equal(read.field_columns, written.field_columns, 0);
}

class VtuEncodings : public Scratch, public testing::WithParamInterface<Encoding> {};

TEST_P(VtuEncodings, ReadBackEqual) {
  const SyntheticRun run;
  const Moment moment{1.0 / 3, 123};
  const std::map<std::string, Dataset> all = {{"particles", run.particles(moment)},
                                              {"surface", run.surface(moment)},
                                              {"bones", run.bones(moment)},
                                              {"frames", run.frames(moment)}};
  for (auto [series, data] : all)
    for (const bool double_precision : {false, true}) {
      data.meta = "{\"name\": \"Ärm\"}";
      write_vtu(folder / "f.vtu", data, {GetParam(), double_precision, series, 0.01});
      expect_equal(read_vtu(folder / "f.vtu"), data, double_precision ? 0 : 0x1p-24);
    }
}

INSTANTIATE_TEST_SUITE_P(All, VtuEncodings,
                         testing::Values(Encoding::zlib, Encoding::lz4, Encoding::raw,
                                         Encoding::none));

std::string header(const std::filesystem::path& path) { return text_of(path); }

/// The opening tag of the array `name`, with its information keys.
std::string tag(const std::string& header, const std::string& name) {
  const auto at = header.find("Name=\"" + name + '"');
  if (at == std::string::npos) return "";
  const auto begin = header.rfind('<', at);
  return header.substr(begin, header.find("<DataArray", at) - begin);
}

TEST_F(Vtu, DefaultIsZlibInTheElementsWithWideHeadersAndNarrowCells) {
  write_vtu(folder / "f.vtu", SyntheticRun().surface({}), {Encoding::zlib, false, "surface", 0.01});
  const std::string text = text_of(folder / "f.vtu");
  const std::string head = header(folder / "f.vtu");
  EXPECT_FALSE(contains(text, "<AppendedData"));
  EXPECT_TRUE(contains(tag(head, "Points"), "format=\"binary\""));
  EXPECT_TRUE(contains(head, "header_type=\"UInt64\""));
  EXPECT_TRUE(contains(head, "compressor=\"vtkZLibDataCompressor\""));
  for (const char* name : {"connectivity", "offsets"})
    EXPECT_TRUE(contains(tag(head, name), "type=\"Int32\"")) << name << tag(head, name);
  EXPECT_TRUE(contains(tag(head, "Points"), "type=\"Float32\""));
  EXPECT_TRUE(contains(tag(head, "bone"), "type=\"Int32\""));
  EXPECT_TRUE(contains(tag(head, "TimeValue"), "type=\"Float64\""));
  EXPECT_TRUE(contains(head, "Scalars=\"bone\" Vectors=\"displacement\""));
}

TEST_F(Vtu, EncodingsAreNamedInTheFile) {
  const Dataset data = SyntheticRun().bones({});
  const auto text = [&](Encoding encoding) {
    write_vtu(folder / "f.vtu", data, {encoding, false, "bones", 0.01});
    return text_of(folder / "f.vtu");
  };
  EXPECT_TRUE(contains(text(Encoding::lz4), "compressor=\"vtkLZ4DataCompressor\""));
  EXPECT_TRUE(contains(text(Encoding::raw), "<AppendedData encoding=\"raw\">"));
  EXPECT_TRUE(contains(text(Encoding::none), "format=\"binary\""));
  EXPECT_FALSE(contains(text(Encoding::none), "compressor="));
  EXPECT_FALSE(contains(text(Encoding::raw), "compressor="));
}

TEST_F(Vtu, EveryArrayCarriesItsUnitAndComponentNames) {
  const SyntheticRun run;
  write_vtu(folder / "f.vtu", run.frames({}), {Encoding::zlib, false, "frames", 0.01});
  const std::string head = header(folder / "f.vtu");
  for (const WrittenArray& row : written_arrays()) {
    if (row.series != "frames") continue;
    const std::string found = tag(head, std::string(row.name));
    EXPECT_TRUE(contains(found, "name=\"UNITS_LABEL\"")) << row.name;
    EXPECT_TRUE(contains(found, std::string(row.unit))) << row.name;
    for (std::size_t k = 0; k < row.components.size(); ++k)
      EXPECT_TRUE(contains(found, "ComponentName" + std::to_string(k) + "=\"" +
                                      std::string(row.components[k]) + '"'))
          << row.name;
  }
}

TEST_F(Vtu, PointsBecomeFloat64WhereFloat32CannotPlaceThem) {
  const auto type = [&](double x) {
    Dataset data;
    data.points = {{0, 0, 0}, {0, x, 0}};
    data.connectivity = vertex_cells(2);
    write_vtu(folder / "f.vtu", data, {Encoding::zlib, false, "particles", 0.01});
    return tag(header(folder / "f.vtu"), "Points");
  };
  EXPECT_TRUE(contains(type(99.9), "Float32"));
  EXPECT_TRUE(contains(type(100.1), "Float64"));
  EXPECT_TRUE(contains(type(-100.1), "Float64"));
}

TEST_F(Vtu, OnlyTheArraysAskedForAreRead) {
  const Dataset data = SyntheticRun().particles({0.5, 3});
  write_vtu(folder / "f.vtu", data, {Encoding::zlib, true, "particles", 0.01});
  const Dataset read = read_vtu(folder / "f.vtu", {"velocity", "absent"});
  ASSERT_EQ(read.point_columns.size(), 1u);
  EXPECT_EQ(vectors(read.point_columns, "velocity"), vectors(data.point_columns, "velocity"));
  EXPECT_EQ(read.points, data.points);
  EXPECT_EQ(read.time, data.time);
  EXPECT_EQ(read.field_columns.size(), data.field_columns.size());
}

TEST_F(Vtu, AnEmptyDatasetComesBackEmpty) {
  write_vtu(folder / "f.vtu", {}, {});
  const Dataset data = read_vtu(folder / "f.vtu");
  EXPECT_EQ(data.points.size(), 0u);
  EXPECT_EQ(data.cells(), 0u);
}

TEST_F(Vtu, AMissingFolderIsNamed) {
  const Error error = error_of([&] { write_vtu(folder / "absent" / "f.vtu", {}, {}); });
  EXPECT_EQ(error.exit(), Exit::not_written);
  EXPECT_TRUE(contains(error.what(), "absent/f.vtu")) << error.what();
}

}  // namespace sinew::vtu_test
