// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces from VTK's files, written by hand: tools/vtk_test.py takes those that VTK and meshio
// write.
#include <sinew/io/vtk/vtk_mesh.h>

#include <cmath>
#include <functional>
#include <random>

#include <sinew/core/triangles.h>
#include <sinew/io/vtk/detail/grids.h>
#include <sinew/mesh/mesh_formats.h>
#include "mesh/shapes.h"
#include "support/expect_error.h"
#include "support/scratch.h"

namespace sinew::vtk_mesh_test {

const std::string unit_points = "0 0 0 1 0 0 0 1 0 0 0 1 1 1 1";

std::string legacy(const std::string& rest) {
  return "# vtk DataFile Version 3.0\ntitle\nASCII\n" + rest;
}

/// Two tetrahedra with one face in common.
std::string tetrahedra(const std::string& types = "10\n10") {
  return legacy("DATASET UNSTRUCTURED_GRID\nPOINTS 5 float\n" + unit_points +
                "\nCELLS 2 10\n4 0 1 2 3\n4 1 2 3 4\nCELL_TYPES 2\n" + types + '\n');
}

std::string xml(const std::string& type, const std::string& rest) {
  return "<VTKFile type=\"" + type + "\" byte_order=\"LittleEndian\"><" + type + rest + "</" +
         type + "></VTKFile>\n";
}

std::string array(const std::string& name, const std::string& type, const std::string& values,
                  int components = 1) {
  return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
         std::to_string(components) + "\" format=\"ascii\">" + values + "</DataArray>";
}

std::string grid_piece(const std::string& points, int count, const std::string& ids,
                       const std::string& ends, const std::string& types, int cells) {
  return "<Piece NumberOfPoints=\"" + std::to_string(count) + "\" NumberOfCells=\"" +
         std::to_string(cells) + "\"><Points>" + array("p", "Float32", points, 3) +
         "</Points><Cells>" + array("connectivity", "Int64", ids) +
         array("offsets", "Int64", ends) + array("types", "UInt8", types) + "</Cells></Piece>";
}

/// An image of the values at n samples along each axis, from -1 to 1.
std::string image(int n, const std::function<double(const Vec3&)>& value) {
  const std::string last = std::to_string(n - 1), step = std::to_string(2.0 / (n - 1));
  std::string values;
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x)
        values += std::to_string(value(Vec3(x, y, z) * 2 / (n - 1) - Vec3::Ones())) + ' ';
  const std::string extent = "\"0 " + last + " 0 " + last + " 0 " + last + '"';
  return xml("ImageData", " WholeExtent=" + extent + " Origin=\"-1 -1 -1\" Spacing=\"" + step +
                              ' ' + step + ' ' + step + "\"><Piece Extent=" + extent +
                              "><PointData Scalars=\"d\">" + array("d", "Float64", values) +
                              "</PointData></Piece>");
}

double ball(const Vec3& at) { return at.norm() - 0.7; }

using shapes::triangles_of;

class VtkMesh : public Scratch {
 protected:
  PolygonSoup soup(const std::string& name, const std::string& text) const {
    put(folder / name, text);
    return read_vtk_mesh(folder / name);
  }

  /// What reading it says; "" where it is taken.
  std::string said(const std::string& name, const std::string& text) const {
    testing::internal::CaptureStderr();
    std::string message;
    try {
      const PolygonSoup read = soup(name, text);
      for (const auto& polygon : read.polygons)
        for (const int corner : polygon)
          EXPECT_TRUE(corner >= 0 && corner < static_cast<int>(read.points.size()));
    } catch (const Error& error) {
      message = error.what();
      EXPECT_EQ(error.exit(), Exit::bad_input);
      EXPECT_TRUE(contains(message, name + ": ") && contains(message, "; ")) << message;
      EXPECT_FALSE(contains(message, "\n")) << message;
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    return message;
  }

  void expect_refused(const std::string& name, const std::string& text,
                      const std::string& part) const {
    const std::string message = said(name, text);
    EXPECT_TRUE(contains(message, part)) << name << ": " << message << "\n" << text.substr(0, 400);
  }
};

TEST_F(VtkMesh, VolumeCellsGiveTheirOuterFaces) {
  const PolygonSoup read = soup("a.vtk", tetrahedra());
  EXPECT_EQ(read.polygons.size(), 6u);
  EXPECT_NEAR(std::abs(volume(triangles_of(read))), 1.0 / 6 + 1.0 / 3, 1e-12);
}

TEST_F(VtkMesh, CellsOfAnyKindAreClosedAndOutward) {
  const std::string cube = "0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1";
  const auto check = [&](const std::string& ids, const std::string& type, int count, double size,
                         const std::string& points) {
    const Triangles faces = triangles_of(soup(
        "a.vtu", xml("UnstructuredGrid",
                     '>' + grid_piece(points, count, ids,
                                      std::to_string(1 + std::count(ids.begin(), ids.end(), ' ')),
                                      type, 1))));
    EXPECT_NEAR(std::abs(volume(faces)), size, 1e-6) << type;
  };
  check("0 1 2 3 4 5 6 7", "12", 8, 1, cube);
  check("0 1 3 2 4 5 7 6", "11", 8, 1, cube);
  check("0 1 3 4 5 7", "13", 8, 0.5, cube);
  check("0 1 2 3 4", "14", 8, 1.0 / 3, cube);
  check("0 1 3 4", "10", 8, 1.0 / 6, cube);
  const std::string middles = " .5 0 0 .5 .5 0 0 .5 0 0 0 .5 .5 0 .5 0 .5 .5";
  check("0 1 2 3 4 5 6 7 8 9", "24", 10, 1.0 / 6, "0 0 0 1 0 0 0 1 0 0 0 1" + middles);
}

TEST_F(VtkMesh, PiecesShareFacesWhereTheirPointsAreEqual) {
  const std::string one = grid_piece("0 0 0 1 0 0 0 1 0 0 0 1", 4, "0 1 2 3", "4", "10", 1),
                    other = grid_piece("1 0 0 0 1 0 0 0 1 1 1 1", 4, "0 1 2 3", "4", "10", 1);
  EXPECT_EQ(soup("a.vtu", xml("UnstructuredGrid", '>' + one + other)).polygons.size(), 6u);
}

TEST_F(VtkMesh, SurfaceCellsAndStripsArePolygons) {
  const std::string points = legacy("DATASET POLYDATA\nPOINTS 5 double\n" + unit_points);
  const PolygonSoup read = soup("a.vtk", points +
                                             "\nVERTICES 1 2\n1 0\nPOLYGONS 2 9\n3 0 1 2\n4 1 2 3 "
                                             "4\nTRIANGLE_STRIPS 1 5\n4 0 1 2 3\nPOINT_DATA 5\n");
  const std::vector<std::vector<int>> expected = {{0, 1, 2}, {1, 2, 3, 4}, {0, 1, 2}, {1, 3, 2}};
  EXPECT_EQ(read.polygons, expected);
}

TEST_F(VtkMesh, ZeroLevelOfABallHasItsVolumeAndArea) {
  const Triangles faces = triangles_of(soup("a.vti", image(40, ball)));
  EXPECT_NEAR(volume(faces), 4 * pi / 3 * 0.343, 0.01 * 1.437);
  EXPECT_NEAR(area(faces), 4 * pi * 0.49, 0.01 * 6.158);
  for (const Vec3& point : faces.points) EXPECT_NEAR(point.norm(), 0.7, 3e-3);
}

TEST_F(VtkMesh, InsideIsWhatTheBorderIsNotWhateverItsSign) {
  const double negative = volume(triangles_of(soup("a.vti", image(16, ball))));
  const auto other = [](const Vec3& at) { return -ball(at); };
  EXPECT_EQ(volume(triangles_of(soup("b.vti", image(16, other)))), negative);
}

TEST_F(VtkMesh, BodiesThatReachTheBorderAreClosedThere) {
  const auto rod = [](const Vec3& at) { return at.head<2>().norm() - 0.5; };
  const PolygonSoup read = soup("a.vti", image(24, rod));
  EXPECT_NEAR(volume(triangles_of(read)), 2 * pi / 4, 0.02 * pi / 2);
  EXPECT_TRUE(contains(read.warning, "border")) << read.warning;
  EXPECT_EQ(soup("b.vti", image(16, ball)).warning, "");
}

TEST_F(VtkMesh, ImagesWithoutANegativeSideHaveTheirSurfaceHalfway) {
  const auto density = [](const Vec3& at) { return 1000 * std::max(0.0, 1 - at.norm()); };
  const PolygonSoup read = soup("a.vti", image(40, density));
  const double radius = std::cbrt(volume(triangles_of(read)) * 3 / (4 * pi));
  EXPECT_NEAR(radius, 0.5, 0.03);
  EXPECT_NE(read.warning.find("the surface is halfway, at 4"), std::string::npos) << read.warning;
}

/// Linear along the radius: the ball at level v has the radius 1 - v / 1000.
TEST_F(VtkMesh, ImagesHaveTheirSurfaceAtTheLevelGiven) {
  const auto density = [](const Vec3& at) { return 1000 * std::max(0.0, 1 - at.norm()); };
  soup("a.vti", image(40, density));
  for (const double level : {200.0, 400.0, 700.0}) {
    const PolygonSoup read = read_vtk_mesh(folder / "a.vti", level);
    const double radius = std::cbrt(volume(triangles_of(read)) * 3 / (4 * pi));
    EXPECT_NEAR(radius, 1 - level / 1000, 0.02) << level;
    EXPECT_EQ(read.warning, "");
  }
  // values of both signs
  soup("b.vti", image(40, ball));
  const double radius =
      std::cbrt(volume(triangles_of(read_vtk_mesh(folder / "b.vti", -0.25))) * 3 / (4 * pi));
  EXPECT_NEAR(radius, 0.45, 0.02);
  test::expect_bad_input([&] { read_vtk_mesh(folder / "a.vti", 2000); },
                         {"level of 2000", "from 0 to", "between them"});
}

TEST_F(VtkMesh, LevelsAreOfImagesAlone) {
  soup("a.vtk", tetrahedra());
  test::expect_bad_input([&] { read_vtk_mesh(folder / "a.vtk", 0.5); },
                         {"no image", "leave out body.level"});
  put(folder / "a.off", "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  test::expect_bad_input([&] { read_polygons((folder / "a.off").string(), {}, 0.5); },
                         {"no image", "leave out body.level"});
}

TEST_F(VtkMesh, LegacyImagesAreLevelSets) {
  const std::string head =
      "DATASET STRUCTURED_POINTS\nDIMENSIONS 3 3 3\nORIGIN 0 0 0\nSPACING 1 1 2\nPOINT_DATA 27\n";
  std::string values;
  for (int i = 0; i < 27; ++i) values += i == 13 ? "-1 " : "1 ";
  const PolygonSoup read =
      soup("a.vtk", legacy(head + "SCALARS d float 1\nLOOKUP_TABLE default\n" + values));
  EXPECT_EQ(read.polygons.size(), 6u);
  EXPECT_GT(volume(triangles_of(read)), 0.1);
  const PolygonSoup field =
      soup("b.vtk", legacy(head + "FIELD FieldData 1\nd 1 27 float\n" + values));
  EXPECT_EQ(field.points, read.points);
}

/// Other arrays before the one that counts, of every kind that the format has.
TEST_F(VtkMesh, LegacyImagesMayHaveTheirValuesAtCells) {
  const std::string head = "DATASET STRUCTURED_POINTS\nDIMENSIONS 4 4 4\nSPACING 1 1 2\n";
  std::string values, vectors, names;
  for (int i = 0; i < 27; ++i)
    (values += i == 13 ? "-1 " : "1 "), (vectors += "0 0 0\n"), (names += "a b\n");
  const std::string field = "FIELD FieldData 2\nnames 1 27 string\n" + names + "d 1 27 float\n" +
                            values + "\nMETADATA\nINFORMATION 0\n\n";
  const std::string cells = "CELL_DATA 27\nVECTORS v double\n" + vectors + "COLOR_SCALARS c 3\n" +
                            vectors + "LOOKUP_TABLE t 1\n0 0 0 1\n" + field;
  const PolygonSoup read = soup("a.vtk", legacy(head + cells));
  const PolygonSoup at_points = soup(
      "b.vtk", legacy("DATASET STRUCTURED_POINTS\nDIMENSIONS 3 3 3\nORIGIN .5 .5 1\nSPACING 1 1 2\n"
                      "POINT_DATA 27\n" +
                      field));
  EXPECT_EQ(read.polygons.size(), 6u);
  EXPECT_EQ(read.points, at_points.points);
  std::string at_corners;
  for (int i = 0; i < 64; ++i) at_corners += i == 21 || i == 22 ? "-1 " : "1 ";
  const PolygonSoup both = soup("c.vtk", legacy(head + cells +
                                                "POINT_DATA 64\nSCALARS d float\n"
                                                "LOOKUP_TABLE default\n" +
                                                at_corners));
  EXPECT_EQ(both.polygons.size(), 10u);
}

TEST_F(VtkMesh, XmlImagesMayHaveTheirValuesAtCells) {
  std::string values;
  for (int i = 0; i < 27; ++i) values += i == 13 ? "-1 " : "1 ";
  const PolygonSoup read =
      soup("a.vti", xml("ImageData", " WholeExtent=\"0 3 0 3 0 3\"><Piece><CellData>" +
                                         array("d", "Float64", values) + "</CellData></Piece>"));
  EXPECT_EQ(read.polygons.size(), 6u);
  EXPECT_EQ(bounds(read.points).center(), Vec3::Constant(1.5));
}

/// Two tetrahedra that share a face, the second twice: as it is, and as a copy or hidden.
TEST_F(VtkMesh, GhostsAndHiddenCellsAreLeftOutAndCounted) {
  const std::string piece =
      grid_piece(unit_points, 5, "0 1 2 3 1 2 3 4 1 2 3 4", "4 8 12", "10 10 10", 3);
  const auto flagged = [&](const std::string& name, const std::string& flags) {
    const std::string data = "<CellData>" + array(name, "UInt8", flags) + "</CellData></Piece>";
    return xml("UnstructuredGrid", '>' + piece.substr(0, piece.size() - 8) + data);
  };
  for (const std::string flags : {"0 0 1", "0 32 0", "0 33 2"}) {
    const PolygonSoup read = soup("a.vtu", flagged("vtkGhostType", flags));
    EXPECT_EQ(read.polygons.size(), 6u) << flags;
    EXPECT_TRUE(contains(read.warning, "1 of 3")) << read.warning;
  }
  EXPECT_EQ(soup("a.vtu", flagged("vtkGhostLevels", "0 2 0")).polygons.size(), 6u);
  EXPECT_EQ(soup("a.vtu", flagged("other", "0 1 0")).warning, "");
  expect_refused("a.vtu", flagged("vtkGhostType", "1 1 32"), "all of its 3 cells");
  const PolygonSoup polygons =
      soup("a.vtp", xml("PolyData",
                        "><Piece NumberOfPoints=\"5\" NumberOfVerts=\"1\" "
                        "NumberOfPolys=\"2\"><Points>" +
                            array("p", "Float32", unit_points, 3) + "</Points><Polys>" +
                            array("connectivity", "Int64", "0 1 2 1 2 3") +
                            array("offsets", "Int64", "3 6") + "</Polys><CellData>" +
                            array("vtkGhostType", "UInt8", "1 0 1") + "</CellData></Piece>"));
  EXPECT_EQ(polygons.polygons, (std::vector<std::vector<int>>{{0, 1, 2}}));
  const PolygonSoup read =
      soup("a.vtk",
           legacy("DATASET POLYDATA\nPOINTS 5 double\n" + unit_points +
                  "\nVERTICES 1 2\n1 0\nPOLYGONS 2 8\n3 0 1 2\n3 1 2 3\nCELL_DATA 3\nFIELD F 1\n"
                  "vtkGhostType 1 3 unsigned_char\n0 32 0\n"));
  EXPECT_EQ(read.polygons, (std::vector<std::vector<int>>{{1, 2, 3}}));
}

TEST_F(VtkMesh, SeveralMomentsAreTold) {
  const std::string piece = grid_piece(unit_points, 5, "0 1 2 3", "4", "10", 1);
  const PolygonSoup read =
      soup("a.vtu", xml("UnstructuredGrid", " TimeValues=\"0 0.5 1\">" + piece));
  EXPECT_TRUE(contains(read.warning, "3 moments, from '0' to '1' s")) << read.warning;
}

TEST_F(VtkMesh, MayBeginWithAByteOrderMark) {
  EXPECT_GT(soup("a.vti", "\xEF\xBB\xBF" + image(12, ball)).polygons.size(), 100u);
}

/// The lowest 32 bits of a type are not its number.
TEST_F(VtkMesh, CellTypesOfMoreThan32BitsAreRefused) {
  EXPECT_EQ(said("a.vtk", tetrahedra()), "");
  EXPECT_NE(said("a.vtk", tetrahedra("4294967306\n10")), "");
}

/// Every edge of a checkerboard crosses its surface: few bytes, gigabytes of faces.
TEST_F(VtkMesh, SurfacesOfNoiseAreRefusedBeforeTheyAreMade) {
  LevelSet image;
  image.size = {100, 100, 100};
  image.bytes = 1'000'000;
  image.values.reserve(1'000'000);
  for (int z = 0; z < 100; ++z)
    for (int y = 0; y < 100; ++y)
      for (int x = 0; x < 100; ++x) image.values.push_back((x + y + z) % 2 == 0 ? 1 : -1);
  const double raised = raised_memory([&] {
    test::expect_bad_input([&] { level_surface(image, {}); }, {"as of noise", "smooth"});
  });
  EXPECT_LT(raised, 20e6);
}

TEST_F(VtkMesh, ErrorsNameTheCure) {
  expect_refused("a.vtk", "", "empty");
  expect_refused("a.vtk", "hello\n", "no legacy VTK file");
  expect_refused("a.vtk", legacy("DATASET STRUCTURED_GRID\n"), "Extract Surface");
  expect_refused("a.vtk", tetrahedra("42\n42"), "Extract Surface");
  expect_refused("a.vtk", tetrahedra("1\n1"), "surface or a volume");
  expect_refused("a.vtk", tetrahedra("10"), "number");
  expect_refused(
      "a.vtk",
      legacy("DATASET POLYDATA\nPOINTS 5 float\n" + unit_points + "\nPOLYGONS 1 3\n2 0 1\n"),
      "too few");
  expect_refused("a.vtu", image(4, ball), "rename it to .vti");
  expect_refused("a.vtp", xml("RectilinearGrid", ">"), "not read");
  const std::string nan = grid_piece("0 0 0 1 0 0 0 1 0 0 0 nan", 4, "0 1 2 3", "4", "10", 1);
  expect_refused("a.vtu", xml("UnstructuredGrid", '>' + nan), "finite");
  expect_refused("a.vti", image(4, [](const Vec3&) { return 1.0; }), "set body.level");
  expect_refused("a.vti", image(4, [](const Vec3& at) { return at.x() < 0 ? NAN : 1.0; }),
                 "finite");
}

TEST_F(VtkMesh, CountsThatAFileCannotHoldAllocateNothing) {
  const std::string huge = "1000000000000";
  const double raised = raised_memory([&] {
    expect_refused("a.vtk", legacy("DATASET POLYDATA\nPOINTS " + huge + " float\n0 0 0"),
                   "cannot hold");
    expect_refused("a.vtk", legacy("DATASET POLYDATA\nPOINTS 9 float\n0 0 0\n"), "cut short");
    expect_refused("a.vtk", legacy("DATASET STRUCTURED_POINTS\nDIMENSIONS " + huge + " 9 9"),
                   "cannot hold");
    expect_refused("a.vti",
                   xml("ImageData", " WholeExtent=\"0 9999 0 9999 0 9999\"><Piece></Piece>"),
                   "cannot hold");
    expect_refused("a.vtu",
                   xml("UnstructuredGrid",
                       "><Piece NumberOfPoints=\"" + huge + "\" NumberOfCells=\"1\"></Piece>"),
                   "cannot hold");
  });
  EXPECT_LT(raised, 50e6);
}

TEST_F(VtkMesh, DamageIsRefusedOrHarmless) {
  const std::vector<std::pair<std::string, std::string>> whole = {
      {"a.vtk", tetrahedra()},
      {"a.vti", image(4, ball)},
      {"a.vtu", xml("UnstructuredGrid",
                    '>' + grid_piece("0 0 0 1 0 0 0 1 0 0 0 1", 4, "0 1 2 3", "4", "10", 1))}};
  std::mt19937 random(1);
  for (const auto& [name, text] : whole)
    for (int trial = 0; trial < 300; ++trial) {
      std::string damaged = text;
      for (int k = 0; k < 3; ++k) {
        const std::size_t at = random() % damaged.size();
        if (random() % 3 == 0)
          damaged.erase(at, random() % 9);
        else
          damaged.insert(at, 1, "-9. <\n\xff"[random() % 7]);
      }
      said(name, damaged);
    }
}

}  // namespace sinew::vtk_mesh_test
