// SPDX-License-Identifier: GPL-3.0-or-later
// Data sets of VTK against the files of the same moment, which VTK's own reader reads.
#include <sinew/vtk/data_sets.h>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCubeSource.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkInformationDoubleKey.h>
#include <vtkInformationStringKey.h>
#include <vtkMassProperties.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkTriangleFilter.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <map>

#include <sinew/io/series_table.h>
#include <sinew/io/single_files.h>
#include <sinew/io/vtu.h>
#include <sinew/run/frame_writer.h>
#include "support/scratch.h"
#include "support/source_dir.h"
#include "support/world.h"

namespace sinew::vtk_data_sets_test {

/// What sinew has made, and what VTK reads.
struct Both {
  vtkDataArray *made, *read;
};

void expect_same_values(const Both& both, bool exact) {
  const std::string name = both.read->GetName() ? both.read->GetName() : "";
  ASSERT_EQ(both.made->GetNumberOfComponents(), both.read->GetNumberOfComponents()) << name;
  ASSERT_EQ(both.made->GetNumberOfTuples(), both.read->GetNumberOfTuples()) << name;
  EXPECT_TRUE(!exact || both.made->GetDataType() == both.read->GetDataType()) << name;
  const bool rounded = both.read->GetDataType() == VTK_FLOAT;
  for (vtkIdType i = 0; i < both.made->GetNumberOfTuples(); ++i)
    for (int k = 0; k < both.made->GetNumberOfComponents(); ++k) {
      const double made = both.made->GetComponent(i, k), read = both.read->GetComponent(i, k);
      if (std::isnan(made) && std::isnan(read)) continue;
      ASSERT_EQ(rounded ? static_cast<double>(static_cast<float>(made)) : made, read)
          << name << ' ' << i << ' ' << k;
    }
}

std::string unit_of(vtkDataArray* array) {
  if (!array->GetInformation()->Has(vtkDataArray::UNITS_LABEL())) return "none";
  return array->GetInformation()->Get(vtkDataArray::UNITS_LABEL());
}

void expect_same_array(const Both& both, bool exact) {
  const std::string name = both.read->GetName();
  EXPECT_EQ(both.made->GetName(), name);
  EXPECT_EQ(unit_of(both.made), unit_of(both.read)) << name;
  EXPECT_NE(unit_of(both.made), "none") << name;
  for (int k = 0; k < both.read->GetNumberOfComponents(); ++k) {
    const char *made = both.made->GetComponentName(k), *read = both.read->GetComponentName(k);
    EXPECT_EQ(made ? std::string(made) : "", read ? std::string(read) : "") << name;
  }
  expect_same_values(both, exact);
}

void expect_same_arrays(vtkFieldData* made, vtkFieldData* read, bool exact) {
  ASSERT_EQ(made->GetNumberOfArrays(), read->GetNumberOfArrays());
  for (int k = 0; k < read->GetNumberOfArrays(); ++k)
    expect_same_array({made->GetArray(k), read->GetArray(k)}, exact);
}

std::string name_of(vtkAbstractArray* array) { return array ? array->GetName() : "none"; }

void expect_same(vtkPointSet& made, vtkPointSet& read, bool exact) {
  expect_same_array({made.GetPoints()->GetData(), read.GetPoints()->GetData()}, exact);
  expect_same_arrays(made.GetPointData(), read.GetPointData(), exact);
  expect_same_arrays(made.GetCellData(), read.GetCellData(), exact);
  expect_same_arrays(made.GetFieldData(), read.GetFieldData(), exact);
  const std::pair<vtkDataSetAttributes*, vtkDataSetAttributes*> attributes[] = {
      {made.GetPointData(), read.GetPointData()}, {made.GetCellData(), read.GetCellData()}};
  for (const auto& [one, other] : attributes) {
    EXPECT_EQ(name_of(one->GetScalars()), name_of(other->GetScalars()));
    EXPECT_EQ(name_of(one->GetVectors()), name_of(other->GetVectors()));
  }
  ASSERT_EQ(made.GetNumberOfCells(), read.GetNumberOfCells());
  vtkNew<vtkIdList> one, other;
  for (vtkIdType i = 0; i < read.GetNumberOfCells(); ++i) {
    ASSERT_EQ(made.GetCellType(i), read.GetCellType(i)) << i;
    made.GetCellPoints(i, one);
    read.GetCellPoints(i, other);
    ASSERT_EQ(one->GetNumberOfIds(), other->GetNumberOfIds());
    for (vtkIdType k = 0; k < one->GetNumberOfIds(); ++k) ASSERT_EQ(one->GetId(k), other->GetId(k));
  }
  EXPECT_EQ(made.GetInformation()->Get(vtkDataObject::DATA_TIME_STEP()),
            read.GetFieldData()->GetArray("TimeValue")->GetComponent(0, 0));
}

vtkSmartPointer<vtkUnstructuredGrid> read_by_vtk(const std::filesystem::path& path) {
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  return reader->GetOutput();
}

/// A bar that bends beside a plane, held and pulled, with everything measured.
Prepared bar(bool double_precision) {
  Settings settings;
  settings.body.mesh = test::source_dir() + "/data/meshes/box.obj";
  settings.body.count = 300;
  settings.bones = {{"lower", "", Vec3(0, 0, 0), Vec3(0, 0, 0.34648)},
                    {"upper", "lower", {}, Vec3(0, 0, 0.69296)}};
  settings.tracks = {test::track("upper", {test::bend_key(0, 0), test::bend_key(0.1, 20)})};
  ObstacleSettings ground;
  ground.name = "ground";
  ground.point = Vec3(0, 0, -0.01);
  settings.world.obstacles = {ground};
  LoadSettings pull;
  pull.name = "pull";
  pull.force = Vec3(0, 0.1, 0);
  pull.part.bone = "upper";
  settings.loads = {pull};
  settings.output.double_precision = double_precision;
  settings.output.arrays = "all";
  settings.output.bonds = true;
  settings.output.skin_lbs = settings.output.skin_dqs = settings.output.volume = true;
  return prepare({settings});
}

/// The first frame and one 0.05 s later, as files and as data sets.
class VtkFrames : public Scratch {
 protected:
  void expect_files_match(bool double_precision) const {
    const Prepared prepared = bar(double_precision);
    Simulation simulation = start(prepared);
    const auto run = folder / "run";  // which is not there yet
    FrameWriter writer(run, prepared.settings.output, prepared);
    FrameData frame(prepared);
    std::map<std::string, vtkSmartPointer<vtkUnstructuredGrid>> grids;  // by the names of files
    for (const std::size_t number : {0, 1}) {
      writer.add(simulation, simulation.time());
      frame.take(simulation);
      for (const std::string_view series : frame.series())
        grids[frame_name(std::string(series), number)] = vtk_grid(frame.dataset(series), series);
      while (simulation.time() < 0.05) simulation.step();
    }
    writer.close();
    EXPECT_EQ(grids.size(), 20u);
    for (const auto& [name, grid] : grids) {
      SCOPED_TRACE(name);
      ASSERT_GT(grid->GetNumberOfCells(), 0);
      expect_same(*grid, *read_by_vtk(run / name), double_precision);
    }
  }
};

TEST_F(VtkFrames, HaveTheBitsOfFilesInDoublePrecision) { expect_files_match(true); }

TEST_F(VtkFrames, HaveTheNumbersOfFilesBeforeTheyAreRounded) { expect_files_match(false); }

TEST_F(VtkFrames, PolygonalDataHasTheSameCellsAndArraysAsTheGrid) {
  const Prepared prepared = bar(false);
  Simulation simulation = start(prepared);
  FrameData frame(prepared);
  frame.take(simulation);
  for (const std::string_view series : frame.series()) {
    if (find_series(series)->cells == CellKind::tetrahedron) continue;  // which it cannot have
    SCOPED_TRACE(series);
    const auto shape = vtk_poly_data(frame.dataset(series), series);
    expect_same(*shape, *vtk_grid(frame.dataset(series), series), true);
    EXPECT_EQ(name_of(shape->GetPointData()->GetNormals()),
              shape->GetPointData()->HasArray("normal") ? "normal" : "none");
  }
}

TEST_F(VtkFrames, OutliveTheirMoment) {
  Prepared prepared = bar(false);
  Simulation simulation = start(prepared);
  vtkSmartPointer<vtkUnstructuredGrid> then;
  {
    FrameData frame(prepared);
    frame.take(simulation);
    then = vtk_grid(frame.particles(), "particles");
  }
  vtkDataArray* at = then->GetPoints()->GetData();
  for (std::size_t i = 0; i < prepared.body.rest.size(); ++i)
    EXPECT_EQ(at->GetComponent(static_cast<vtkIdType>(i), 2), prepared.body.rest[i].z());
}

TEST(VtkBody, HasTheArraysOfItsFile) {
  const TempFolder folder;
  const Prepared prepared = bar(false);
  write_body(folder.path() / "body.vtu", prepared.filled);
  expect_same(*vtk_grid(body_dataset(prepared.filled), "body"),
              *read_by_vtk(folder.path() / "body.vtu"), true);
}

TEST(VtkPolyData, OfACubeHasItsVolumeAndArea) {
  vtkNew<vtkCubeSource> cube;
  vtkNew<vtkTriangleFilter> triangles;
  triangles->SetInputConnection(cube->GetOutputPort());
  triangles->Update();
  const PolygonSoup soup = polygons_of(*triangles->GetOutput());
  Dataset data;
  data.points = soup.points;
  for (Vec3& point : data.points) point *= 2;
  data.kind = CellKind::triangle;
  for (const auto& corners : soup.polygons)
    data.connectivity.insert(data.connectivity.end(), corners.begin(), corners.end());
  const auto shape = vtk_poly_data(data, "surface");
  vtkNew<vtkMassProperties> mass;
  mass->SetInputData(shape);
  EXPECT_NEAR(mass->GetVolume(), 8, 1e-12);
  EXPECT_NEAR(mass->GetSurfaceArea(), 24, 1e-12);
  EXPECT_EQ(polygons_of(*shape).polygons, soup.polygons);  // there and back
  EXPECT_EQ(polygons_of(*shape).points, data.points);
}

TEST(VtkPolyData, LinesBesideTrianglesKeepTheirValues) {
  Dataset data;
  data.points = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  data.kind = CellKind::triangle;
  data.connectivity = {0, 1, 2, 2, 1, 0};
  data.lines = {0, 1, 1, 2, 2, 0};
  data.cell_columns = {column("defect", std::vector<std::int32_t>{6, 5, 1, 2, 3}),
                       column("component", std::vector<double>{0.5, 1.5, -1, -2, -3})};
  const auto shape = vtk_poly_data(data, "defects");
  const auto grid = vtk_grid(data, "defects");
  const int of_lines_first[] = {1, 2, 3, 6, 5}, of_triangles_first[] = {6, 5, 1, 2, 3};
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(shape->GetCellType(i), i < 3 ? VTK_LINE : VTK_TRIANGLE);
    EXPECT_EQ(shape->GetCellData()->GetArray("defect")->GetComponent(i, 0), of_lines_first[i]);
    EXPECT_EQ(grid->GetCellType(i), i < 2 ? VTK_TRIANGLE : VTK_LINE);
    EXPECT_EQ(grid->GetCellData()->GetArray("defect")->GetComponent(i, 0), of_triangles_first[i]);
  }
  EXPECT_EQ(shape->GetCellData()->GetArray("component")->GetComponent(0, 0), -1);
  EXPECT_EQ(shape->GetCellData()->GetArray("component")->GetComponent(4, 0), 1.5);
}

TEST(VtkPolyData, OfNothingIsEmpty) {
  EXPECT_EQ(vtk_poly_data({}, "surface")->GetNumberOfCells(), 0);
  EXPECT_EQ(vtk_grid({}, "particles")->GetNumberOfPoints(), 0);
}

}  // namespace sinew::vtk_data_sets_test
