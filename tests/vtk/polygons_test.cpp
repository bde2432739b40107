// SPDX-License-Identifier: GPL-3.0-or-later
// Shapes of VTK as polygons: volumes in closed form and by vtkMassProperties, and the reader of
// files.
#include <sinew/vtk/data_sets.h>

#include <vtkAppendFilter.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkCubeSource.h>
#include <vtkDoubleArray.h>
#include <vtkImageData.h>
#include <vtkMassProperties.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkRectilinearGrid.h>
#include <vtkSphereSource.h>
#include <vtkStripper.h>
#include <vtkTriangleFilter.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataWriter.h>

#include <cmath>
#include <limits>

#include <sinew/io/vtk/vtk_mesh.h>
#include <sinew/repair/read_surface.h>
#include "mesh/shapes.h"
#include "support/expect_error.h"
#include "support/scratch.h"

namespace sinew::vtk_polygons_test {

using shapes::triangles_of;

vtkSmartPointer<vtkPolyData> ball() {
  vtkNew<vtkSphereSource> source;
  source->SetThetaResolution(24);
  source->SetPhiResolution(15);
  source->Update();
  return source->GetOutput();
}

double volume_by_vtk(vtkPolyData* shape) {
  vtkNew<vtkTriangleFilter> triangles;
  triangles->SetInputData(shape);
  vtkNew<vtkMassProperties> mass;
  mass->SetInputConnection(triangles->GetOutputPort());
  return mass->GetVolume();
}

/// Four points of a square, and what the caller adds.
vtkSmartPointer<vtkPolyData> square(int precision = VTK_FLOAT) {
  vtkNew<vtkPoints> points;
  points->SetDataType(precision);
  for (const auto& [x, y] : {std::pair(0.0, 0.0), {1.0, 0.0}, {1.0, 1.0 / 3}, {0.0, 1.0 / 3}})
    points->InsertNextPoint(x, y, 0);
  auto shape = vtkSmartPointer<vtkPolyData>::New();
  shape->SetPoints(points);
  return shape;
}

void set_polygon(vtkPolyData& shape, std::initializer_list<vtkIdType> corners) {
  vtkNew<vtkCellArray> cells;
  cells->InsertNextCell(corners);
  shape.SetPolys(cells);
}

TEST(PolygonsOfVtk, TrianglesOfASourceHaveItsVolume) {
  const auto shape = ball();
  const PolygonSoup soup = polygons_of(*shape);
  EXPECT_EQ(static_cast<vtkIdType>(soup.polygons.size()), shape->GetNumberOfPolys());
  EXPECT_NEAR(volume(triangles_of(soup)), volume_by_vtk(shape), 1e-6);
  EXPECT_NEAR(volume(triangles_of(soup)), pi / 6, 0.03 * pi / 6);
}

TEST(PolygonsOfVtk, PolygonsKeepTheirCornersAndPointsTheirPrecision) {
  for (const int precision : {VTK_FLOAT, VTK_DOUBLE}) {
    const auto shape = square(precision);
    set_polygon(*shape, {0, 1, 2, 3});
    const PolygonSoup soup = polygons_of(*shape);
    EXPECT_EQ(soup.polygons, (std::vector<std::vector<int>>{{0, 1, 2, 3}}));
    EXPECT_EQ(soup.points[2].y(), precision == VTK_FLOAT ? double(1.0F / 3) : 1.0 / 3);
  }
}

TEST(PolygonsOfVtk, StripsBecomeTrianglesOfTheSameSide) {
  const auto shape = ball();
  vtkNew<vtkStripper> stripper;
  stripper->SetInputData(shape);
  stripper->Update();
  ASSERT_GT(stripper->GetOutput()->GetNumberOfStrips(), 0);
  const Triangles plain = triangles_of(polygons_of(*shape)),
                  strips = triangles_of(polygons_of(*stripper->GetOutput()));
  EXPECT_EQ(strips.faces.size(), plain.faces.size());
  EXPECT_NEAR(volume(strips), volume(plain), 1e-12);
  EXPECT_NEAR(area(strips), area(plain), 1e-12);
}

TEST(PolygonsOfVtk, VerticesAndLinesAreLeftOut) {
  const auto shape = square();
  set_polygon(*shape, {0, 1, 2});
  vtkNew<vtkCellArray> vertices, lines;
  vertices->InsertNextCell({3});
  lines->InsertNextCell({2, 3});
  shape->SetVerts(vertices);
  shape->SetLines(lines);
  EXPECT_EQ(polygons_of(*shape).polygons, (std::vector<std::vector<int>>{{0, 1, 2}}));
  EXPECT_EQ(polygons_of(*shape).points.size(), 4u);
}

TEST(PolygonsOfVtk, GridsGiveTheirOuterFaces) {
  vtkNew<vtkDoubleArray> edges;
  for (const double at : {0.0, 0.3, 1.0}) edges->InsertNextValue(at);
  vtkNew<vtkRectilinearGrid> grid;  // eight boxes
  grid->SetDimensions(3, 3, 3);
  grid->SetXCoordinates(edges);
  grid->SetYCoordinates(edges);
  grid->SetZCoordinates(edges);
  vtkNew<vtkAppendFilter> cells;
  cells->SetInputData(grid);
  cells->Update();
  for (vtkDataSet* shape :
       {static_cast<vtkDataSet*>(grid), static_cast<vtkDataSet*>(cells->GetOutput())}) {
    const Triangles surface = triangles_of(polygons_of(*shape));
    EXPECT_EQ(surface.faces.size(), 48u);
    EXPECT_NEAR(volume(surface), 1, 1e-12);
    EXPECT_NEAR(area(surface), 6, 1e-12);
  }
}

TEST(PolygonsOfVtk, GhostsAndHiddenCellsAreLeftOutAndCounted) {
  vtkNew<vtkImageData> one, other;  // each of 3 x 2 x 2 boxes, of which 2 x 2 are in both
  one->SetExtent(0, 3, 0, 2, 0, 2);
  other->SetExtent(2, 5, 0, 2, 0, 2);
  vtkNew<vtkUnsignedCharArray> flags;
  flags->SetName("vtkGhostType");
  for (vtkIdType i = 0; i < 24; ++i) flags->InsertNextValue(i >= 12 && i % 3 == 0 ? 1 : 0);
  for (const bool merged : {false, true}) {
    vtkNew<vtkAppendFilter> both;
    both->AddInputData(one);
    both->AddInputData(other);
    both->SetMergePoints(merged);
    both->Update();
    both->GetOutput()->GetCellData()->AddArray(flags);
    const PolygonSoup soup = polygons_of(*both->GetOutput());
    EXPECT_EQ(soup.polygons.size(), 48u);
    EXPECT_NEAR(volume(triangles_of(soup)), 20, 1e-12);
    EXPECT_NE(soup.warning.find("4 of 24"), std::string::npos) << soup.warning;
  }
  const auto shape = square();
  set_polygon(*shape, {0, 1, 2});
  shape->GetPolys()->InsertNextCell({0, 2, 3});
  vtkNew<vtkUnsignedCharArray> hidden;
  hidden->SetName("vtkGhostType");
  hidden->InsertNextValue(32);
  hidden->InsertNextValue(2);
  shape->GetCellData()->AddArray(hidden);
  EXPECT_EQ(polygons_of(*shape).polygons, (std::vector<std::vector<int>>{{0, 2, 3}}));
}

/// A source that has each corner three times, for its normals.
TEST(PolygonsOfVtk, ACubeOfASourceIsClosedOnceItIsPrepared) {
  vtkNew<vtkCubeSource> cube;
  cube->Update();
  const PolygonSoup soup = polygons_of(*cube->GetOutput());
  EXPECT_EQ(soup.points.size(), 24u);
  const Surface surface = prepare(soup, {});
  EXPECT_EQ(surface.triangles.points.size(), 8u);
  EXPECT_NEAR(volume(surface.triangles), 1, 1e-12);
}

class VtkFile : public Scratch {};

TEST_F(VtkFile, PolygonsAreThoseOfTheFileThatVtkWrites) {
  vtkNew<vtkStripper> stripper;
  stripper->SetInputData(ball());
  stripper->SetMaximumLength(7);
  stripper->Update();
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputData(stripper->GetOutput());
  writer->SetFileName((folder / "ball.vtp").c_str());
  writer->Write();
  const PolygonSoup file = read_vtk_mesh(folder / "ball.vtp"),
                    memory = polygons_of(*stripper->GetOutput());
  EXPECT_EQ(memory.points, file.points);
  EXPECT_EQ(memory.polygons, file.polygons);
}

TEST(PolygonsOfVtk, RefusesWhatHasNoSurfaceAndNamesTheCure) {
  vtkNew<vtkPolyData> empty;
  test::expect_bad_input([&] { polygons_of(*empty); }, {"is empty; ", "Update()"});
  vtkNew<vtkUnstructuredGrid> no_cells;
  test::expect_bad_input([&] { polygons_of(*no_cells); }, {"is empty; "});
  vtkNew<vtkImageData> image;
  image->SetDimensions(3, 3, 3);
  test::expect_bad_input([&] { polygons_of(*image); }, {"image", "vtkFlyingEdges3D"});
  const auto lines = square();
  vtkNew<vtkCellArray> line;
  line->InsertNextCell({0, 1});
  lines->SetLines(line);
  test::expect_bad_input([&] { polygons_of(*lines); }, {"no polygons", "; give the surface"});
}

TEST(PolygonsOfVtk, RefusesDamagedCellsAndPoints) {
  const auto short_one = square();
  set_polygon(*short_one, {0, 1});
  test::expect_bad_input([&] { polygons_of(*short_one); },
                         {"polygon 0 of 2 points, too few", "; "});
  for (const vtkIdType beyond : {4, -1}) {
    const auto shape = square();
    set_polygon(*shape, {0, 1, beyond});
    test::expect_bad_input([&] { polygons_of(*shape); },
                           {"polygon 0 with point " + std::to_string(beyond) + " of 4", "; "});
  }
  for (const double value : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    const auto shape = square();
    set_polygon(*shape, {0, 1, 2});
    shape->GetPoints()->SetPoint(2, 0, value, 0);
    test::expect_bad_input([&] { polygons_of(*shape); }, {"point 2", "not finite; give"});
  }
}

}  // namespace sinew::vtk_polygons_test
