// SPDX-License-Identifier: GPL-3.0-or-later
// Mesh files that are cut short, lie, or are something else: each gives exit code 2 and one line
// that names the file and a cure, or the part of the mesh that is there; none a crash.
#include <gtest/gtest.h>

#include <array>
#include <cctype>
#include <cmath>

#include <sinew/core/error.h>
#include <sinew/repair/read_surface.h>
#include "mesh/mesh_files.h"
#include "mesh/shapes.h"
#include "mesh/surface_laws.h"
#include "support/expect_error.h"

namespace sinew::mesh_test {

using mesh_files::Folder;

/// What reading the file says; "" where it is taken, and then gives a surface that can be used.
/// Whatever it says has the form of an error line.
std::string answer(const std::string& path) {
  try {
    const Surface surface = read_surface(mesh_files::body_at(path));
    EXPECT_FALSE(surface.triangles.faces.empty());
    EXPECT_EQ(laws::border_with_caps(surface), 0u);
    return {};
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_EQ(error.exit(), Exit::bad_input) << message;
    EXPECT_EQ(message.rfind(path + ":", 0), 0u) << message;
    EXPECT_NE(message.find("; "), std::string::npos) << message;
    for (const char c : message)
      EXPECT_FALSE(std::iscntrl(static_cast<unsigned char>(c))) << message;
    EXPECT_LT(message.size(), path.size() + 300) << message;
    return message;
  }
}

void expect_refused(const std::string& name, const std::string& content,
                    const std::string& part = "") {
  const Folder folder;
  const std::string message = answer(folder.file(name, content));
  EXPECT_FALSE(message.empty()) << name << '\n' << content.substr(0, 300);
  EXPECT_NE(message.find(part), std::string::npos) << message;
}

struct Format {
  std::string name, content;
};

/// The formats in which faces name their points.
std::vector<Format> indexed_formats(const PolygonSoup& soup) {
  return {{"a.obj", mesh_files::obj(soup)},
          {"a.off", mesh_files::off(soup)},
          {"a.ply", mesh_files::ply(soup)},
          {"b.ply", mesh_files::ply_binary(soup)},
          {"c.ply", mesh_files::ply_binary(soup, true)}};
}

std::vector<Format> formats(const PolygonSoup& soup = shapes::sphere(1, 2)) {
  std::vector<Format> all = indexed_formats(soup);
  all.push_back({"a.stl", mesh_files::stl(soup)});
  all.push_back({"b.stl", mesh_files::stl_binary(soup)});
  return all;
}

TEST(Mesh, IsTakenWhenNothingIsWrong) {
  for (const auto& [name, content] : formats()) {
    const Folder folder;
    EXPECT_EQ(answer(folder.file(name, content)), "") << name;
  }
}

/// A file made from `whole` must be refused, or hold nothing but polygons of it, as many as `most`.
/// Its last polygon may have lost digits.
void expect_refused_or_part_of(const PolygonSoup& whole, std::size_t most, const Format& file) {
  const Folder folder;
  const std::string path = folder.file(file.name, file.content);
  if (!answer(path).empty()) return;
  const PolygonSoup part = read_polygons(path);
  EXPECT_LE(part.polygons.size(), most) << file.name;
  for (std::size_t i = 0; i + 1 < part.polygons.size(); ++i)
    EXPECT_EQ(part.polygons[i], whole.polygons[i]) << file.name;
  for (std::size_t i = 0; i + 1 < std::min(part.points.size(), whole.points.size()); ++i)
    EXPECT_EQ(part.points[i], whole.points[i]) << file.name;
}

TEST(Mesh, CutAtAnyTenthIsRefusedUnlessNothingTellsItsLength) {
  const auto soup = shapes::sphere(1, 2);
  for (const auto& [name, content] : formats(soup))
    for (std::size_t tenth = 0; tenth < 10; ++tenth) {
      const std::string cut = content.substr(0, content.size() * tenth / 10);
      if (name == "a.obj" && tenth > 0)
        expect_refused_or_part_of(soup, soup.polygons.size() - 1, {name, cut});
      else
        expect_refused(name, cut);
    }
}

TEST(Mesh, CutAnywhereIsRefusedOrSmaller) {
  const auto soup = shapes::burst(shapes::tetrahedron());  // every format keeps its order
  for (const auto& [name, content] : formats(soup))
    for (std::size_t size = 0; size < content.size();
         size += size < 150 || size + 50 > content.size() ? 1 : 13) {
      const std::string cut = content.substr(0, size);
      const std::size_t end = name == "a.stl" ? 7 : 2;  // the solid's name, or the last digit
      if (name == "a.obj" || size + end >= content.size())
        expect_refused_or_part_of(soup, soup.polygons.size(), {name, cut});
      else
        expect_refused(name, cut);
    }
}

std::string with(std::string text, const std::string& old, const std::string& other) {
  return text.replace(text.find(old), old.size(), other);
}

TEST(Mesh, WithOtherCountsThanItHasIsRefusedOrSmaller) {
  const auto soup = shapes::sphere(1, 1);  // 18 points, 32 faces
  const std::vector<std::string> points = {"0",  "1",          "17",          "19",
                                           "36", "2000000000", "99999999999", "-18"};
  const std::vector<std::string> faces = {"0",  "1",          "31",          "33",
                                          "64", "2000000000", "99999999999", "-32"};
  for (const auto& [name, content] : formats(soup)) {
    for (const std::string& count : points) {
      if (name == "a.off")
        expect_refused_or_part_of(soup, 32, {name, with(content, "18 32", count + " 32")});
      if (name.ends_with("ply"))
        expect_refused_or_part_of(soup, 32, {name, with(content, "vertex 18", "vertex " + count)});
    }
    for (const std::string& count : faces) {
      if (name == "a.off")
        expect_refused_or_part_of(soup, 31, {name, with(content, "18 32", "18 " + count)});
      if (name.ends_with("ply"))
        expect_refused_or_part_of(soup, 31, {name, with(content, "face 32", "face " + count)});
    }
  }
}

TEST(Mesh, WithAPointThatIsNoNumberIsRefused) {
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    auto soup = shapes::sphere(1, 1);
    soup.points[7].y() = bad;
    for (const auto& [name, content] : formats(soup)) expect_refused(name, content, "not");
  }
}

TEST(Mesh, WithACornerThatIsNoPointIsRefused) {
  for (const int bad : {18, 19, 1000000, -1, -40, 2147483646, -2147483647}) {
    auto soup = shapes::sphere(1, 1);
    soup.polygons[9][1] = bad;
    for (const auto& [name, content] : indexed_formats(soup)) expect_refused(name, content);
  }
}

TEST(Mesh, WithAnyByteBrokenIsTakenOrRefusedButNeverCrashes) {
  for (const auto& [name, content] : formats(shapes::tetrahedron())) {
    const Folder folder;
    constexpr char bytes[] = {'\0', '\xff', '9', '-', '\n'};
    for (std::size_t i = 0; i < content.size(); ++i) {
      std::string broken = content;
      broken[i] = bytes[i % sizeof bytes];
      answer(folder.file(name, broken));
    }
  }
}

TEST(Mesh, OfGarbageIsRefused) {
  std::string garbage;
  std::mt19937 random(7);
  for (int i = 0; i < 20000; ++i) garbage += static_cast<char>(random());
  for (const char* extension : {"obj", "off", "ply", "stl"}) {
    const std::string name = std::string("a.") + extension;
    expect_refused(name, garbage);
    expect_refused(name, "");
    expect_refused(name, " \n\n \t\n");
    expect_refused(name, std::string(5000, '\0'));
    expect_refused(name, "hello, this is a letter and no mesh\n");
  }
}

TEST(Mesh, UnderAnotherExtensionIsRefused) {
  const auto soup = shapes::tetrahedron();
  expect_refused("a.obj", mesh_files::ply(soup), "rename it to .ply");
  expect_refused("a.off", mesh_files::stl(soup), "rename it to .stl");
  expect_refused("a.stl", mesh_files::off(soup), "rename it to .off");
  expect_refused("a.ply", mesh_files::obj(soup));
  expect_refused("a.stl", mesh_files::obj(soup));
  expect_refused("a.obj", mesh_files::stl_binary(soup));
  expect_refused("a.glb", mesh_files::obj(soup), "'.glb' file");
  expect_refused("mesh", mesh_files::obj(soup), "without extension");
}

TEST(Mesh, ThatIsNoFileIsRefused) {
  const Folder folder;
  std::filesystem::create_directory(folder.path("folder.obj"));
  EXPECT_NE(answer(folder.path("missing.obj")).find("there is no such file"), std::string::npos);
  EXPECT_NE(answer(folder.path("folder.obj")).find("not a file"), std::string::npos);
  EXPECT_NE(answer(folder.path(std::string(5000, 'x') + ".obj")), "");
}

TEST(Obj, NamesTheLineAtFault) {
  const std::string good = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\n";
  for (const auto& [line, part] : std::vector<std::array<std::string, 2>>{
           {"f 3 1 5", "a.obj:8: the face names vertex 5 of 4"},
           {"f 3 1 0", "a.obj:8: the face's corner '0' names no vertex"},
           {"f 3 1 -5", "a.obj:8: the face's corner '-5'"},
           {"f 3 1 99999999999999999999", "a.obj:8: the face's corner"},
           {"f 3 1 4294967297", "a.obj:8: the face names vertex 4294967297"},
           {"f 3 1 x", "a.obj:8: the face's corner 'x'"},
           {"v 1 2", "a.obj:8: the vertex has fewer than 3"},
           {"v 1 2 nan", "a.obj:8: the coordinate 'nan' is not a finite"},
           {"v 1 -inf 2", "a.obj:8: the coordinate '-inf'"},
           {"v 1 1e400 2", "a.obj:8: the coordinate '1e400'"},
           {"v 0,5 1 2", "a.obj:8: the coordinate '0,5'"},
           {"v 1 2 \\\n\n", "a.obj:8: the vertex has fewer than 3"}}) {
    expect_refused("a.obj", good + line + "\n", part);
  }
}

TEST(Off, NamesTheLineAtFault) {
  const std::string points = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n", faces = "3 0 2 1\n3 0 1 3\n3 1 2 3\n";
  expect_refused("a.off", "OFF\n4 4 0\n" + points + faces + "3 2 0 4\n",
                 "a.off:10: the face names vertex '4' of 4");
  expect_refused("a.off", "OFF\n4 4 0\n" + points + faces + "3 2 0 -1\n", "a.off:10:");
  expect_refused("a.off", "OFF\n4 4 0\n" + points + faces + "4 2 0 3\n",
                 "fewer corners than it says");
  expect_refused("a.off", "OFF\n4 4 0\n" + points + faces + "-3 2 0 3\n", "'-3' corners");
  expect_refused("a.off", "OFF\n4 4 0\n" + points + faces + "4000000000 2 0 3\n");
  expect_refused("a.off", "OFF\n4 5 0\n" + points + faces + "3 2 0 3\n", "ends early");
  expect_refused("a.off", "OFF\n4000000000 4000000000 0\n" + points, "ends early");
  expect_refused("a.off", "OFF\n4000000000000000000000 4 0\n" + points);
  expect_refused("a.off", "OFF\n-4 4 0\n" + points + faces);
  expect_refused("a.off", "OFF\n4 0 0\n" + points, "its faces");
  expect_refused("a.off", "OFF\n4 4 0\n0 0 nan\n" + points, "a.off:3: the coordinate 'nan'");
  expect_refused("a.off", std::string("OFF BINARY\n\0\0\0\4\0\0\0\4", 19), "binary OFF");
  expect_refused("a.off", "4OFF\n4 4 0\n" + points + faces, "3 dimensions");
}

std::string ply_of(const std::string& vertex, const std::string& face, const std::string& body,
                   const std::string& vertices = "4", const std::string& faces = "4") {
  return "ply\nformat ascii 1.0\nelement vertex " + vertices + '\n' + vertex + "element face " +
         faces + '\n' + face + "end_header\n" + body;
}

TEST(Ply, SaysWhatIsWrong) {
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  const std::string list = "property list uchar int vertex_indices\n";
  const std::string points = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
  const std::string body = points + "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
  expect_refused("a.ply", ply_of("property float x\nproperty float y\n", list, body),
                 "no number z");
  expect_refused("a.ply", ply_of(xyz, "property list uchar float vertex_indices\n", body),
                 "of type float");
  expect_refused("a.ply", ply_of(xyz, "property list uchar int corners\n", body),
                 "no list vertex_indices");
  expect_refused("a.ply", ply_of(xyz, "property list float int vertex_indices\n", body),
                 "must be an integer");
  expect_refused("a.ply", ply_of(xyz, "property quad x\n", body), "a.ply:8: unknown type 'quad'");
  expect_refused("a.ply", ply_of(xyz, list, body, "400000000000"),
                 "a.ply:3: the number of elements");
  expect_refused("a.ply", ply_of(xyz, list, body, "-4"), "a.ply:3: the number of elements");
  expect_refused("a.ply", ply_of(xyz, list, body, "2000000000"));
  expect_refused("a.ply", ply_of(xyz, list, body, "4", "2000000000"), "the file ends early");
  expect_refused("a.ply", ply_of(xyz, list, body, "4", "0"), "no faces, only points");
  expect_refused("a.ply", ply_of(xyz, list, points + "3 0 2 4\n3 0 1 3\n3 1 2 3\n3 2 0 3\n"),
                 "a.ply:14: a face names vertex 4 of 4");
  expect_refused("a.ply", ply_of(xyz, list, points + "3 0 2 -1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n"),
                 "vertex -1 of 4");
  expect_refused("a.ply", ply_of(xyz, list, points + "300 0 2 1\n"),
                 "'300' is no number of type uchar");
  expect_refused("a.ply", ply_of(xyz, list, points + "2 0 1\n2 0 1\n2 0 1\n2 0 1\n"));
  expect_refused("a.ply", ply_of(xyz, list, "0 0 nan\n" + body), "a.ply:10: 'nan' is not a finite");
  expect_refused("a.ply", ply_of("", list, body), "has no properties");
  expect_refused("a.ply", "ply\nformat ascii 1.0\nproperty float x\nend_header\n",
                 "precedes the first element");
  expect_refused("a.ply", "ply\nelement vertex 4\n" + xyz + "end_header\n", "no format");
  expect_refused("a.ply",
                 "ply\nformat ascii 1.0\nelement vertex 4\n" + xyz +
                     "element tristrips 1\nproperty list int int vertex_indices\nend_header\n" +
                     points + "5 0 1 2 -1 4\n",
                 "a face names vertex 4 of 4");
}

TEST(Ply, BelievesNoLengthOfABinaryList) {
  const std::string head =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list int int vertex_indices\nend_header\n";
  for (const std::int32_t length : {2147483647, -1, -2147483647, 4}) {
    std::string bytes = head + std::string(12, '\0');
    mesh_files::append(bytes, length);
    expect_refused("a.ply", bytes + std::string(12, '\0'),
                   length < 0 ? "negative length" : "ends early");
  }
}

TEST(Stl, SaysWhatIsWrong) {
  const auto soup = shapes::tetrahedron();
  std::string binary = mesh_files::stl_binary(soup);
  std::string more = binary, most = binary, none = binary.substr(0, 84), wild = binary;
  more[80] = 5;
  most.replace(80, 4, "\xff\xff\xff\xff");
  none.replace(80, 4, std::string(4, '\0'));
  wild.replace(96, 4, "\xff\xff\xff\x7f");
  expect_refused("a.stl", more, "says 5 triangles but holds 4");
  expect_refused("a.stl", most, "says 4294967295 triangles but holds 4");
  expect_refused("a.stl", none, "no triangles");
  expect_refused("a.stl", wild, "triangle 0 has a coordinate that is not finite");
  expect_refused("a.stl", "solid\nfacet\nouter loop\nvertex 0 0 x\n",
                 "a.stl:4: the coordinate 'x'");
  expect_refused("a.stl", "solid\nfacet\nvertex 0 0 0\nvertex 0 0 1\nendfacet\nendsolid\n",
                 "has 2 corners");
  expect_refused("a.stl", "solid\nfacet\nvertex 0 0\nendfacet\nendsolid\n",
                 "a.stl:4: the coordinate 'endfacet'");
  expect_refused("a.stl", "solid\nfacet\nvertex 0 0", "fewer than 3 coordinates");
  expect_refused("a.stl", "solid empty\nendsolid empty\n", "no triangles");
}

TEST(Surface, ThatIsBrokenIsTakenAndCounted) {
  auto open = shapes::box(Vec3::Zero(), Vec3::Ones()), crowded = open;
  open.polygons.pop_back();
  crowded.polygons.push_back({0, 3, 7, 4});
  const auto overlapping =
      shapes::together(shapes::sphere(1, 2), shapes::sphere(1, 2, Vec3(1, 0.1, 0.2)));
  const PolygonSoup sheet{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}};
  const Folder folder;
  const auto border = [&](const Format& file) {
    return read_surface(mesh_files::body_at(folder.file(file.name, file.content))).border;
  };
  for (const Format& file : formats(open)) EXPECT_EQ(border(file).edges, 4u) << file.name;
  for (const Format& file : formats(crowded)) EXPECT_GT(border(file).crowded_edges, 0u);
  for (const Format& file : formats(overlapping)) EXPECT_EQ(border(file).holes, 0u) << file.name;
  for (const Format& file : formats(sheet)) EXPECT_EQ(border(file).holes, 1u) << file.name;
}

TEST(Surface, WithoutAFaceIsRefused) {
  const PolygonSoup point{{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, {{0, 1, 2}}};
  for (const auto& [name, content] : formats(point)) expect_refused(name, content, "collapsed");
}

TEST(Surface, OfLooseFacesOnlyHasNoHolesToClose) {
  const PolygonSoup loose = shapes::burst(shapes::sphere(1, 2), 0.5);
  const Folder folder;
  for (const auto& [name, content] : formats(loose)) {
    BodyOptions body = mesh_files::body_at(folder.file(name, content));
    body.close_holes = true;
    test::expect_bad_input([&] { read_surface(body); },
                           {body.mesh + ": all 128 faces are loose", "; ", "thickness"});
  }
}

TEST(Surface, OfATangleIsTakenSoon) {
  PolygonSoup tangle;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(0, 1);
  for (int i = 0; i < 3000; ++i) {
    for (int j = 0; j < 4; ++j)
      tangle.points.emplace_back(place(random), place(random), place(random));
    for (const auto& f : shapes::tetrahedron().polygons)
      tangle.polygons.push_back({4 * i + f[0], 4 * i + f[1], 4 * i + f[2]});
  }
  const Folder folder;
  EXPECT_EQ(
      read_surface(mesh_files::body_at(folder.file("a.obj", mesh_files::obj(tangle)))).components,
      3000);
}

TEST(Surface, OfAllFacesAtOneEdgeIsTakenSoon) {
  PolygonSoup book{{{0, 0, 0}, {0, 0, 1}}, {}};
  for (int i = 0; i < 50000; ++i) {
    book.points.emplace_back(std::cos(i), std::sin(i), 0.5);
    book.polygons.push_back({0, 1, i + 2});
  }
  const Folder folder;
  const Surface surface =
      read_surface(mesh_files::body_at(folder.file("a.obj", mesh_files::obj(book))));
  EXPECT_EQ(surface.border.crowded_edges, 1u);
  EXPECT_EQ(surface.triangles.faces.size(), 50000u);
}

TEST(Face, OfVeryManyCornersIsRefusedSoon) {
  std::string text, face = "f";
  for (int i = 1; i <= 100000; ++i) {
    const double a = i * 6e-5, rho = i % 2 ? 1 : 0.9;
    (text += "v ") += mesh_files::line(Vec3(rho * std::cos(a), rho * std::sin(a), 0));
    face.append(" ").append(std::to_string(i));
  }
  expect_refused("a.obj", text + face + '\n', "has 100000 corners");
}

}  // namespace sinew::mesh_test
