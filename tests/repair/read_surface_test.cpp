// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/repair/read_surface.h>

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "mesh/mesh_files.h"
#include "mesh/shapes.h"
#include "support/expect_error.h"

namespace sinew::read_surface_test {

using mesh_files::Folder;

/// Odd numbers that need all their digits.
PolygonSoup awkward() {
  auto soup = shapes::sphere(1.0 / 3, 1, Vec3(0.1, 1e-9, 12345.678));
  soup.points[0] += Vec3(1e-17, 0, 0);
  return soup;
}

TEST(Read, TakesEveryDigitFromObjOffAndPly) {
  const Folder folder;
  const auto soup = awkward();
  for (const auto& [name, content] :
       std::map<std::string, std::string>{{"a.obj", mesh_files::obj(soup)},
                                          {"a.OFF", mesh_files::off(soup)},
                                          {"a.ply", mesh_files::ply(soup)},
                                          {"b.ply", mesh_files::ply_binary(soup)},
                                          {"c.Ply", mesh_files::ply_binary(soup, true)}}) {
    const PolygonSoup read = read_polygons(folder.file(name, content));
    EXPECT_EQ(read.points, soup.points) << name;
    EXPECT_EQ(read.polygons, soup.polygons) << name;
  }
}

TEST(Look, IsThatOfThePolygonInTheSamePlace) {
  const Folder folder;
  BodyOptions body;
  body.mesh = folder.file("a.obj",
                          "mtllib my materials.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\n"
                          "v 1 0 0\nvt 0 0\nvt 1 0 0\nvt 1 1\nvt 0 1\n"
                          "f 1 5 2\ng base plate\nusemtl wood\nf 1/1 4/4 3/3/1 6/-3\n"
                          "g\nf 2/9 3/1 5/1\nf 3//2 4//1 5\nf 4 1 5\n");
  body.unit = LengthUnit::mm;
  const Triangles surface = read_surface(body).triangles;
  const SurfaceLook look = look_of(body, surface);
  EXPECT_EQ(look.libraries.at(0).substr(look.libraries[0].rfind('/')), "/my materials.mtl");
  ASSERT_EQ(look.part.size(), surface.faces.size());
  int in_base = 0;
  for (std::size_t i = 0; i < surface.faces.size(); ++i) {
    const bool base = look.part[i] >= 0 && look.parts[look.part[i]].group == "base plate";
    in_base += base;
    for (int k = 0; k < 3; ++k) {  // the coordinates are those of the places
      ASSERT_EQ(look.corners[i][k] >= 0, base);
      if (!base) continue;
      const Vec3& point = surface.points[surface.faces[i][k]];
      const auto& [u, v] = look.coordinates[look.corners[i][k]];
      EXPECT_EQ((std::array{1e-3 * u, 1e-3 * v}), (std::array{point.x(), point.y()}));
    }
  }
  EXPECT_EQ(in_base, 2);
  body.mesh = folder.file("a.off", mesh_files::off(shapes::sphere(1, 1)));
  EXPECT_TRUE(look_of(body, read_surface(body).triangles).part.empty());
}

TEST(Look, HasTheNormalsOfAnObjTurnedIntoTheScene) {
  const Folder folder;
  BodyOptions body;
  body.mesh = folder.file("a.obj",
                          "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 -3\nvn 0 nan 0\n"
                          "f 1//1 3//1 2//-2\nf 1//2 2//2 4//2\nf 2//1 3//9 4//1\nf 1 4 3\n");
  body.up = Axis::y;
  body.forward = Axis::z;
  const Triangles surface = read_surface(body).triangles;
  const SurfaceLook look = look_of(body, surface);
  const Vec3 below = placement_of(body).turn * Vec3(0, 0, -1);
  int with = 0;
  for (const auto& corners : look.normal_corners) {
    with += corners[0] == 0;
    EXPECT_EQ(corners[0] < 0, corners[2] < 0);  // whole or none
  }
  EXPECT_EQ(with, 1);
  EXPECT_LT((look.normals.at(0) - below).norm(), 1e-12);
  EXPECT_TRUE(look.normals.at(1).isZero(0));
}

TEST(Look, HasTheMaterialsOfTheLibrary) {
  const Folder folder;
  BodyOptions body;
  folder.file("a.mtl",
              "Kd 9 9 9\nnewmtl  two words \nKd 0.5 nan 7\nTr 0.25\nmap_Kd sub\\my image.png\n"
              "newmtl bare\nmap_Kd -bm 1 b.png\nd x\n");
  body.mesh = folder.file(
      "a.obj", "mtllib a.mtl\nmtllib missing.mtl\n" + mesh_files::obj(shapes::sphere(1, 1)));
  const SurfaceLook look = look_of(body, read_surface(body).triangles);
  ASSERT_EQ(look.materials.size(), 2U);
  const auto& [name, color, opacity, image] = look.materials[0];
  EXPECT_EQ(name, "two words");
  EXPECT_EQ(color, (std::array{0.5, 1.0, 1.0}));
  EXPECT_EQ(opacity, 0.75);
  EXPECT_TRUE(image.ends_with("/sub/my image.png")) << image;
  EXPECT_TRUE(look.materials[1].image.ends_with("/b.png"));
  EXPECT_EQ(look.materials[1].opacity, 1);
}

TEST(Read, TakesTextAndBinaryStl) {
  const Folder folder;
  const auto soup = shapes::torus(1, 0.25, 8, 6);
  const double expected = volume(
      read_surface(mesh_files::body_at(folder.file("a.obj", mesh_files::obj(soup)))).triangles);
  const auto text = read_surface(mesh_files::body_at(folder.file("a.stl", mesh_files::stl(soup))));
  const auto binary =
      read_surface(mesh_files::body_at(folder.file("b.stl", mesh_files::stl_binary(soup))));
  EXPECT_EQ(text.triangles.points.size(), soup.points.size());
  EXPECT_EQ(binary.triangles.points.size(), soup.points.size());
  EXPECT_NEAR(volume(text.triangles), expected, 0.1);  // quads are cut along the other diagonal
  EXPECT_NEAR(volume(binary.triangles), volume(text.triangles), 1e-6);
}

TEST(Read, TellsTextFromBinaryStlWhateverTheFirstWord) {
  const Folder folder;
  const auto soup = shapes::tetrahedron();
  for (const std::string first : {"solid\tbody\n", "solid\n", "SOLID body\r\n", "  solid a b c\n"})
    EXPECT_EQ(read_polygons(folder.file("a.stl", mesh_files::stl(soup, first))).polygons.size(),
              4u);
  const std::string binary = mesh_files::stl_binary(soup, "solid endsolid ");
  EXPECT_EQ(read_polygons(folder.file("b.stl", binary)).polygons.size(), 4u);
  EXPECT_EQ(read_polygons(folder.file("c.stl", binary + std::string(7, '\0'))).polygons.size(), 4u);
}

TEST(Read, TellsWhatIsNotRead) {
  const Folder folder;
  const auto soup = shapes::tetrahedron();
  std::string binary = mesh_files::stl_binary(soup);
  binary[80] = 3;
  EXPECT_NE(read_polygons(folder.file("a.stl", binary)).warning, "");
  EXPECT_NE(
      read_polygons(folder.file("a.obj", mesh_files::obj(soup) + "surf 0 1 0 1 1 2 3 4\n")).warning,
      "");
}

TEST(Read, LeavesOutFacesOfFewerThanThreeCorners) {
  const Folder folder;
  PolygonSoup flat = shapes::tetrahedron();
  flat.polygons.insert(flat.polygons.begin() + 1, {0, 1});
  flat.polygons.push_back({2});
  for (const auto& [name, text] : {std::pair("a.obj", mesh_files::obj(flat)),
                                   {"a.off", mesh_files::off(flat)},
                                   {"a.ply", mesh_files::ply(flat)},
                                   {"b.ply", mesh_files::ply_binary(flat)}}) {
    const PolygonSoup soup = read_polygons(folder.file(name, text));
    EXPECT_EQ(soup.polygons, shapes::tetrahedron().polygons) << name;
    EXPECT_EQ(soup.warning, "2 faces have fewer than three corners: left out") << name;
  }
  PolygonLook look;
  EXPECT_EQ(read_obj_look(folder.path("a.obj"), look).polygons.size(), 4u);
  EXPECT_EQ(look.look.part.size(), 4u);
  EXPECT_EQ(look.corners.size(), 4u);
  flat.polygons = {{0, 1}};
  test::expect_bad_input([&] { read_polygons(folder.file("c.off", mesh_files::off(flat))); },
                         {"no faces but 1 face has fewer than three corners"});
}

TEST(Read, TakesStlAsExported) {
  const Folder folder;
  const auto soup = shapes::tetrahedron();
  std::string text = mesh_files::stl(soup);
  text.replace(text.rfind("endsolid body"), 13, "end solid body");
  EXPECT_EQ(read_polygons(folder.file("a.stl", text)).polygons.size(), 4u);
  EXPECT_EQ(read_polygons(folder.file("b.stl", text + text)).polygons.size(), 8u);
  std::string colored = mesh_files::stl_binary(soup), stuffed = colored;
  for (std::size_t i = 1; i <= 4; ++i) colored[84 + 50 * i - 1] = '\x7f';
  EXPECT_EQ(read_polygons(folder.file("c.stl", colored)).polygons.size(), 4u);
  for (std::size_t i = 4; i > 0; --i) {
    stuffed[84 + 50 * i - 2] = 5;
    stuffed.insert(84 + 50 * i, "12345");
  }
  test::expect_bad_input([&] { read_polygons(folder.file("d.stl", stuffed)); },
                         {"20 bytes of attributes", "without attributes"});
}

TEST(Read, TakesLinesOfOldMacs) {
  const Folder folder;
  const auto soup = shapes::tetrahedron();
  for (auto [name, text] : {std::pair("a.obj", mesh_files::obj(soup)),
                            {"a.off", mesh_files::off(soup)},
                            {"a.ply", mesh_files::ply(soup)},
                            {"a.stl", mesh_files::stl(soup)}}) {
    std::replace(text.begin(), text.end(), '\n', '\r');
    EXPECT_EQ(read_polygons(folder.file(name, text)).polygons.size(), 4u) << name;
  }
  std::string binary = mesh_files::ply_binary(soup);
  std::replace(binary.begin(),
               binary.begin() + static_cast<std::ptrdiff_t>(binary.find("end_header") + 11), '\n',
               '\r');
  EXPECT_EQ(read_polygons(folder.file("b.ply", binary)).polygons, soup.polygons);
}

TEST(Read, TakesSeveralSolidsOfAnStl) {
  const Folder folder;
  const auto far = shapes::moved(shapes::tetrahedron(), Vec3(5, 0, 0));
  const auto path =
      folder.file("a.stl", mesh_files::stl(shapes::tetrahedron()) + mesh_files::stl(far));
  EXPECT_EQ(read_surface(mesh_files::body_at(path)).components, 2);
}

TEST(Read, TurnsTheMeshAsTheBodySays) {
  const Folder folder;
  BodyOptions body = mesh_files::body_at(folder.file(
      "a.obj", mesh_files::obj(shapes::box(Vec3::Zero(), Vec3(1, 2, 3)))));  // x 1, y 2, z 3 long
  const auto sizes = [&] { return Vec3(bounds(read_surface(body).triangles.points).sizes()); };
  body.scale = 2;
  body.up = Axis::y;
  EXPECT_EQ(sizes(), Vec3(6, 2, 4)) << "z is forward where y is up";
  EXPECT_GT(volume(read_surface(body).triangles), 0) << "turned, not mirrored";
  body.forward = Axis::minus_x;
  EXPECT_EQ(sizes(), Vec3(2, 6, 4));
  EXPECT_LT(bounds(read_surface(body).triangles.points).min().x(), -1.5);
  body.rotation = Vec3(0, 90, 0);  // after up and forward
  body.offset = Vec3(10, 20, 30);  // after scale
  EXPECT_EQ(sizes(), Vec3(4, 6, 2));
  EXPECT_EQ(bounds(read_surface(body).triangles.points).min().z(), 30);
}

TEST(Read, TakesObjAsProgramsWriteIt) {
  const Folder folder;
  const std::string text =
      "mtllib a.mtl\r\n# \xC3\xA9\r\nv 0 0 0 1.0\r\nv\t1 0 0 0.1 0.2 0.3\r\nv 0 1 \\\r\n 0\r\nv +0 "
      ".0 1.\r\n"
      "vt 0 0\r\nvn 0 0 1\r\ncall x\r\nl 1 2\r\ng all\r\nf\t1/1/1\t3/1/1\t2/1/1\r\nf 1//1 2//1 "
      "4//1\r\n"
      "f -3 -2 -1\r\nf 3/1 \\\r\n1/1 4/1";
  const Surface surface = read_surface(mesh_files::body_at(folder.file("a.obj", text)));
  EXPECT_EQ(surface.triangles.points, shapes::tetrahedron().points);
  EXPECT_DOUBLE_EQ(volume(surface.triangles), 1.0 / 6);
}

TEST(Read, LosesNoLineOfAnObjToABackslash) {
  const Folder folder;
  const auto read = [&](const std::string& text) {
    const PolygonSoup soup = read_polygons(folder.file("a.obj", text));
    EXPECT_EQ(soup.points, shapes::tetrahedron().points) << text;
    EXPECT_EQ(soup.polygons, shapes::tetrahedron().polygons) << text;
    return soup.warning;
  };
  const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
  const std::string faces = "f 1 3 2\nf 1 2 4 # last \\\nf 2 3 4\nf 3 1 4\n";
  EXPECT_EQ(read("# C:\\models\\\n" + points + "# a \\\r\n" + faces), "");
  EXPECT_EQ(read(points + "g a \\\nb\nf 1 \\\r\n 3 2 \\\n" + faces.substr(faces.find('\n'))), "");
  EXPECT_NE(read("mtllib C:\\tex\\\n" + points + faces), "");
  EXPECT_NE(read(points + "usemtl a\\b\\\r\n" + faces), "");
  EXPECT_NE(read(points + "vn 0 0 1 \\\n" + faces), "");
  PolygonLook look;
  read_obj_look(folder.file("a.obj", points + "usemtl a\\b\\\n" + faces), look);
  EXPECT_EQ(look.look.parts.at(0).material, "a\\b\\");
}

TEST(Read, TakesOffWithColorsAndCountsOnTheFirstLine) {
  const Folder folder;
  const std::string body =
      "0 0 0 255 0 0\n1 0 0 0 0 0 # red\n\n0 1 0 9 9 9\n0 0 1 1 1 1\n"
      "3 0 2 1 0.5 0.5 0.5\n3 0 1 3\n3 1 2 3 7\n3 2 0 3";
  for (const std::string head :
       {"COFF\n4 4 6\n", "OFF 4 4 6\n", "4 4 6\n", "\xEF\xBB\xBFOFF\n# x\n4 4 0\n"})
    EXPECT_EQ(
        read_surface(mesh_files::body_at(folder.file("a.off", head + body))).triangles.faces.size(),
        4u)
        << head;
}

TEST(Read, TakesOffInLinesOfAnyLength) {
  const Folder folder;
  const std::string points = "0 0 0  1 0 0 # a comment\n0 1 0\n0 0\n1\n";
  const std::string faces = "3 0\n2 1 3 0 1 3 3 1 2 3\n\n3\n2\n0 3\n";
  const std::string rows = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
  for (const std::string& text :
       {"OFF 4 4 6\n" + points + faces, "OFF\n4\n4\n6\n" + points + faces,
        "OFF4 4 6\n" + points + faces, "off\n4 4\n6\n" + rows, "OFF4 4 0\n" + rows,
        std::string("CNOFF 4 4 0 0 0 0 0 0 1 .1 .2 .3 1\n1 0 0 0 0 1 1 0 0 1 0 1 0 0 0 1 0 1 0 1 "
                    "0 0 1 0 0 1 1 1 1 1\n") +
            faces,
        std::string(
            "OFF\n4 4\n6\n0 0\n0 9 9 9\n1 0 0\n0 1 0\n0 0 1 8\n3 0 2 1 255 0 0\n3 0\n1 3 .5\n3 1 2 "
            "3\n3 2 0 3")}) {
    const PolygonSoup soup = read_polygons(folder.file("a.off", text));
    EXPECT_EQ(soup.points, shapes::tetrahedron().points) << text;
    EXPECT_EQ(soup.polygons, shapes::tetrahedron().polygons) << text;
    EXPECT_EQ(soup.warning, "");
  }
  EXPECT_NE(read_polygons(folder.file("a.off", "OFF\n4 3 0\n" + rows)).warning, "");
}

TEST(Read, TakesPlyWithOtherElementsAndProperties) {
  const Folder folder;
  const std::string text =
      "ply\r\ncomment first\r\nformat ascii 1.0\r\nobj_info x\r\nelement camera 1\r\nproperty "
      "float fov\r\n"
      "element vertex 4\r\nproperty uint8 red\r\nproperty float32 x\r\nproperty float "
      "y\r\nproperty double z\r\n"
      "element face 4\r\nproperty list uint8 float weights\r\nproperty list int32 uint32 "
      "vertex_index\r\n"
      "property uchar flag\r\nend_header\r\n0.5\r\n1 0 0 0\r\n2 1 0 0\r\n3 0 1 0\r\n4 0 0 1\r\n"
      "0 3 0 2 1 1\r\n1 0.5 3 0 1 3 1\r\n0 3 1 2 3 1\r\n0 3 2 0 3 1\r\n";
  EXPECT_EQ(read_surface(mesh_files::body_at(folder.file("a.ply", text))).triangles.points,
            shapes::tetrahedron().points);
}

TEST(Read, TakesPlyWithNumbersOfAnyType) {
  const Folder folder;
  const std::string head = "ply\nformat ascii 1.0\nelement vertex 4\n";
  const std::string body = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
  for (const std::string type : {"short", "uint8", "int", "double"})
    for (const std::string index : {"uchar", "ushort", "int8", "uint"}) {
      std::string text = head;
      for (const char* axis : {"x", "y", "z"}) text += "property " + type + ' ' + axis + '\n';
      text += "element face 4\nproperty list uchar " + index + " vertex_indices\nend_header\n";
      EXPECT_EQ(read_polygons(folder.file("a.ply", text + body)).points,
                shapes::tetrahedron().points);
    }
}

TEST(Read, TakesPlyWithTriangleStrips) {
  const Folder folder;
  std::string text = mesh_files::ply(shapes::tetrahedron());
  text.replace(text.find("element face 4"), std::string::npos,
               "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
               "0 0 0\n1 0 0\n0 1 0\n0 0 1\n13 0 2 1 3 -1 -1 1 -1 2 0 3 -1 2\n");
  const std::vector<std::vector<int>> expected = {{0, 2, 1}, {2, 3, 1}, {2, 0, 3}};
  EXPECT_EQ(read_polygons(folder.file("a.ply", text)).polygons, expected);
}

TEST(Read, TakesPlyWithLinesLongerThanItsHeaderSays) {
  const Folder folder;
  const auto soup = shapes::tetrahedron();
  std::string text = mesh_files::ply(soup), longer;
  const std::size_t body = text.find("end_header\n") + 11;
  for (const char c : text.substr(body))
    longer += c == '\n' ? std::string(" 7 7\n") : std::string(1, c);
  const PolygonSoup read = read_polygons(folder.file("a.ply", text.substr(0, body) + longer));
  EXPECT_EQ(read.points, soup.points);
  EXPECT_EQ(read.polygons, soup.polygons);
  EXPECT_NE(read.warning.find("8 lines are longer"), std::string::npos) << read.warning;
  std::replace(text.begin() + static_cast<std::ptrdiff_t>(body), text.end(), ' ', '\n');
  EXPECT_EQ(read_polygons(folder.file("b.ply", text)).polygons, soup.polygons);
}

TEST(Read, ScalesAndWelds) {
  const Folder folder;
  auto torn = shapes::burst(shapes::tetrahedron(1000));
  torn.points[0].x() += 0.5;
  const std::string path = folder.file("a.obj", mesh_files::obj(torn));
  BodyOptions body = mesh_files::body_at(path);
  body.scale = 1e-3;
  EXPECT_FALSE(read_surface(body).closed());
  body.weld = 1e-3;
  const Surface surface = read_surface(body);
  EXPECT_TRUE(surface.closed());
  EXPECT_NEAR(volume(surface.triangles), 1.0 / 6, 1e-3);
  for (const double scale : {0.0, -1.0, std::nan("")}) {
    body.scale = scale;
    test::expect_bad_input([&] { read_surface(body); }, {path + ": the scale is", "above 0"});
  }
}

TEST(Read, PassesTheRuleOn) {
  const auto soup = shapes::together(shapes::sphere(1, 2), shapes::sphere(0.5, 2));
  const double one = volume(prepare(shapes::sphere(1, 2), {}).triangles);
  BodyOptions hollow;
  hollow.rule = FillRule::hollow;
  EXPECT_NEAR(volume(prepare(soup, hollow).triangles), one * 7 / 8, 1e-12);
  EXPECT_NEAR(volume(prepare(soup, {}).triangles), one * 9 / 8, 1e-12);
}

TEST(Soup, IsCheckedBeforeItIsUsed) {
  const auto good = shapes::tetrahedron();
  EXPECT_EQ(prepare(good, {}).components, 1);
  const auto refused = [](const PolygonSoup& soup, const std::string& part) {
    test::expect_bad_input([&] { prepare(soup, {}); }, {part, "; "});
  };
  refused({good.points, {}}, "there are no faces");
  auto bad = good;
  bad.polygons[2][1] = 4;
  refused(bad, "vertex 4 of 4");
  bad.polygons[2][1] = -1;
  refused(bad, "vertex -1 of 4");
  bad.polygons[2].resize(2);
  refused(bad, "2 corners");
  bad = good;
  bad.points[3].y() = std::nan("");
  refused(bad, "vertex 3 has a coordinate that is not finite");
}

TEST(Read, TakesFormatsOfOtherFoldersAndNamesThemAll) {
  const Folder folder;
  const MeshFormat more[] = {
      {"One", ".one", [](const std::string&) { return shapes::tetrahedron(); }}};
  EXPECT_EQ(mesh_format_names(), "OBJ, OFF, STL, PLY");
  EXPECT_EQ(mesh_format_names(more), "OBJ, OFF, STL, PLY, One");
  const std::string path = folder.file("a.ONE", "any words");
  EXPECT_EQ(read_surface(mesh_files::body_at(path), more).triangles.faces.size(), 4u);
  test::expect_bad_input([&] { read_polygons(path); }, {path + ": a mesh cannot be a '.one' file",
                                                        "give an .obj, .off, .stl or .ply file"});
  test::expect_bad_input([&] { read_polygons(folder.file("a.two", "any words"), more); },
                         {"give an .obj, .off, .stl, .ply or .one file"});
  test::expect_bad_input([&] { read_polygons(folder.path("missing.two")); },
                         {"there is no such file"});
}

TEST(Read, NamesTheFileInWhatCleaningRefuses) {
  const Folder folder;
  const std::string path = folder.file("point.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n");
  test::expect_bad_input([&] { read_surface(mesh_files::body_at(path)); },
                         {path + ": all 1 faces are collapsed"});
}

}  // namespace sinew::read_surface_test
