// SPDX-License-Identifier: GPL-3.0-or-later
// Files as VTK's own writer leaves them, which is ParaView's, in all its modes.
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkStringArray.h>
#include <vtkTypeInt64Array.h>
#include <vtkTypeUInt16Array.h>
#include <vtkTypeUInt64Array.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <cmath>

#include <sinew/io/vtu.h>
#include "support/scratch.h"

namespace sinew::vtu_foreign_test {

constexpr int count = 20'000;  // several blocks

struct Mode {
  int data;        // vtkXMLWriter::Ascii, Binary, Appended
  int compressor;  // vtkXMLWriter::NONE, LZ4, ZLIB, LZMA
  bool base64 = false;
  int header = vtkXMLWriter::UInt64;
  int order = vtkXMLWriter::LittleEndian;
};

template <class Array, class Value>
void add(vtkFieldData& to, const char* name, int components, Value value, int rows = count) {
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(rows);
  for (vtkIdType i = 0; i < array->GetNumberOfValues(); ++i) array->SetValue(i, value(i));
  to.AddArray(array);
}

double real(vtkIdType i) { return std::sin(0.1 * static_cast<double>(i)) / 3; }
vtkIdType whole(vtkIdType i) { return (i * i) % 251; }

/// Points on a line, joined one by one.
vtkNew<vtkUnstructuredGrid> grid_of(int points) {
  vtkNew<vtkUnstructuredGrid> grid;
  vtkNew<vtkPoints> places;
  places->SetDataTypeToDouble();
  for (int i = 0; i < points; ++i)
    places->InsertNextPoint(real(3 * i), real(3 * i + 1), real(3 * i + 2));
  grid->SetPoints(places);
  for (vtkIdType i = 0; i + 1 < points; ++i) {
    const vtkIdType ends[2] = {i + 1, i};
    grid->InsertNextCell(VTK_LINE, 2, ends);
  }
  vtkPointData& of_points = *grid->GetPointData();
  add<vtkDoubleArray>(of_points, "doubles", 1, real, points);
  add<vtkFloatArray>(
      of_points, "floats", 3, [](vtkIdType i) { return float(real(i)); }, points);
  add<vtkTypeUInt16Array>(
      of_points, "shorts", 2, [](vtkIdType i) { return vtkTypeUInt16(whole(i)); }, points);
  add<vtkTypeInt64Array>(of_points, "narrow", 1, whole, points);
  add<vtkTypeUInt64Array>(
      of_points, "wide", 1, [](vtkIdType i) { return vtkTypeUInt64(whole(i)) << 40; }, points);
  add<vtkUnsignedCharArray>(
      *grid->GetCellData(), "bytes", 1,
      [](vtkIdType i) { return static_cast<unsigned char>(whole(i)); },
      points > 0 ? points - 1 : 0);
  add<vtkDoubleArray>(
      *grid->GetFieldData(), "TimeValue", 1, [](vtkIdType) { return 0.1; }, 1);
  add<vtkIntArray>(
      *grid->GetFieldData(), "CYCLE", 1, [](vtkIdType) { return 7; }, 1);
  add<vtkIntArray>(
      *grid->GetFieldData(), "others", 2, [](vtkIdType i) { return int(i); }, 3);
  return grid;
}

class ForeignVtu : public Scratch, public testing::WithParamInterface<Mode> {
 protected:
  std::filesystem::path written(vtkUnstructuredGrid& grid, const Mode& mode) const {
    vtkNew<vtkXMLUnstructuredGridWriter> writer;
    const auto path = folder / "f.vtu";
    writer->SetFileName(path.c_str());
    writer->SetInputData(&grid);
    writer->SetDataMode(mode.data);
    writer->SetCompressorType(mode.compressor);
    writer->SetEncodeAppendedData(mode.base64);
    writer->SetHeaderType(mode.header);
    writer->SetByteOrder(mode.order);
    EXPECT_TRUE(writer->Write());
    return path;
  }
};

void expect_values(const std::vector<Column>& columns, const char* name, int components,
                   double (*value)(vtkIdType)) {
  const Column* column = find(columns, name);
  ASSERT_TRUE(column) << name;
  EXPECT_EQ(column->components, components);
  std::visit(
      [&](const auto& values) {
        for (std::size_t i = 0; i < values.size(); ++i)
          ASSERT_EQ(static_cast<double>(values[i]), value(static_cast<vtkIdType>(i))) << name << i;
      },
      column->values);
}

TEST_P(ForeignVtu, IsReadAsItWasMade) {
  const Dataset data = read_vtu(written(*grid_of(count), GetParam()));
  ASSERT_EQ(data.points.size(), std::size_t{count});
  for (std::size_t i = 0; i < data.points.size(); ++i)
    for (int k = 0; k < 3; ++k)
      ASSERT_EQ(data.points[i][k], real(static_cast<vtkIdType>(3 * i) + k));
  EXPECT_EQ(data.kind, CellKind::line);
  ASSERT_EQ(data.connectivity.size(), 2u * (count - 1));
  for (std::size_t i = 0; i < data.connectivity.size(); ++i)
    ASSERT_EQ(data.connectivity[i], static_cast<int>(i / 2 + 1 - i % 2));
  ASSERT_EQ(data.point_columns.size(), 5u);
  expect_values(data.point_columns, "doubles", 1, real);
  expect_values(data.point_columns, "floats", 3,
                [](vtkIdType i) { return double(float(real(i))); });
  expect_values(data.point_columns, "shorts", 2, [](vtkIdType i) { return double(whole(i)); });
  expect_values(data.point_columns, "wide", 1,
                [](vtkIdType i) { return double(whole(i)) * 0x1p40; });
  EXPECT_EQ(integers(data.point_columns, "narrow").size(), std::size_t{count});
  expect_values(data.cell_columns, "bytes", 1, [](vtkIdType i) { return double(whole(i)); });
  EXPECT_EQ(data.time, 0.1);
  EXPECT_EQ(data.cycle, 7);
  ASSERT_EQ(data.field_columns.size(), 1u);
  EXPECT_EQ(std::get<0>(data.field_columns[0].values),
            (std::vector<std::int32_t>{0, 1, 2, 3, 4, 5}));
}

TEST_P(ForeignVtu, OfNoPointsIsRead) {
  const Dataset data = read_vtu(written(*grid_of(0), GetParam()));
  EXPECT_EQ(data.points.size(), 0u);
  EXPECT_EQ(data.cells(), 0u);
  EXPECT_EQ(data.cycle, 7);
}

TEST_P(ForeignVtu, HasOnlyTheArraysAskedFor) {
  const Dataset data = read_vtu(written(*grid_of(10), GetParam()), {"floats", "absent"});
  ASSERT_EQ(data.point_columns.size(), 1u);
  EXPECT_EQ(data.point_columns[0].name, "floats");
}

using W = vtkXMLWriter;
INSTANTIATE_TEST_SUITE_P(
    All, ForeignVtu,
    testing::Values(Mode{W::Ascii, W::NONE}, Mode{W::Binary, W::NONE}, Mode{W::Binary, W::ZLIB},
                    Mode{W::Binary, W::LZ4}, Mode{W::Binary, W::NONE, false, W::UInt32},
                    Mode{W::Binary, W::ZLIB, false, W::UInt32}, Mode{W::Appended, W::NONE},
                    Mode{W::Appended, W::ZLIB}, Mode{W::Appended, W::LZ4},
                    Mode{W::Appended, W::ZLIB, false, W::UInt32},
                    Mode{W::Appended, W::NONE, false, W::UInt32}, Mode{W::Appended, W::NONE, true},
                    Mode{W::Appended, W::ZLIB, true}, Mode{W::Appended, W::LZ4, true},
                    Mode{W::Appended, W::NONE, true, W::UInt32},
                    Mode{W::Appended, W::ZLIB, true, W::UInt32}));

class RefusedVtu : public ForeignVtu {
 protected:
  void expect_refused(vtkUnstructuredGrid& grid, const Mode& mode, const char* why) const {
    const auto path = written(grid, mode);
    const Error error = error_of([&] { read_vtu(path); });
    EXPECT_EQ(error.exit(), Exit::bad_input);
    EXPECT_TRUE(contains(error.what(), why)) << error.what();
  }
};

TEST_F(RefusedVtu, IsThatOfAMachineOrACompressorThatWeDoNotHave) {
  expect_refused(*grid_of(5), {W::Binary, W::ZLIB, false, W::UInt64, W::BigEndian}, "big-endian");
  expect_refused(*grid_of(5), {W::Binary, W::LZMA}, "'vtkLZMADataCompressor'");
}

TEST_F(RefusedVtu, HoldsWords) {
  auto grid = grid_of(5);
  vtkNew<vtkStringArray> words;
  words->SetName("label");
  for (int i = 0; i < 5; ++i) words->InsertNextValue("a");
  grid->GetPointData()->AddArray(words);
  expect_refused(*grid, {W::Binary, W::ZLIB}, "array 'label' is not numeric");
  EXPECT_EQ(read_vtu(folder / "f.vtu", {"wide"}).point_columns.size(), 1u);
}

TEST_F(RefusedVtu, HasAnArrayTooShortOrTooFarBehind) {
  const auto path = written(*grid_of(5), {W::Appended, W::NONE});
  const std::string text = text_of(path);
  for (const auto& [old, other, why] : std::vector<std::array<std::string, 3>>{
           {"offset=\"0\"", "offset=\"100000\"", "is damaged"},
           {"offset=\"0\"", "offset=\"-1\"", "offset is '-1'"},
           {"NumberOfPoints=\"5\"", "NumberOfPoints=\"4\"", "is damaged"},
           {"NumberOfComponents=\"3\"", "NumberOfComponents=\"0\"", "0 components"},
           {"format=\"appended\"", "format=\"telegram\"", "is damaged"},
           {"<AppendedData", "<AppendedDat", ""}}) {
    std::string changed = text;
    ASSERT_NE(changed.find(old), changed.npos) << old;
    put(path, changed.replace(changed.find(old), old.size(), other));
    const Error error = error_of([&] { read_vtu(path); });
    EXPECT_TRUE(contains(error.what(), why)) << old << ": " << error.what();
  }
}

}  // namespace sinew::vtu_foreign_test
