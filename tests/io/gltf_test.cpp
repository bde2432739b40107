// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/geometry.h>

#include "io/gltf_files.h"

namespace sinew::gltf_test {

using namespace gltf_files;

constexpr double single = 1e-6;  // what single precision leaves of a unit length

class ReadGltf : public Scratch {
 protected:
  PolygonSoup read(const Gltf& gltf, Form form = Form::embedded) const {
    return read_gltf(write(folder, gltf, form));
  }
};

/// The corners' places, triangle by triangle: the same for any numbering of vertices.
Points corners_of(const PolygonSoup& soup) {
  Points corners;
  for (const auto& polygon : soup.polygons)
    for (const int corner : polygon) corners.push_back(soup.points.at(corner));
  return corners;
}

void expect_near(const Points& points, const Points& expected) {
  ASSERT_EQ(points.size(), expected.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_LT((points[i] - expected[i]).norm(), single) << i << ": " << points[i].transpose();
}

double volume(const PolygonSoup& soup) {
  const Points c = corners_of(soup);
  double six = 0;
  for (std::size_t i = 0; i < c.size(); i += 3) six += c[i].dot(c[i + 1].cross(c[i + 2]));
  return six / 6;
}

Points moved(const Points& points, const Eigen::Affine3d& by) {
  Points out;
  for (const Vec3& point : points) out.push_back(by * point);
  return out;
}

TEST_F(ReadGltf, TakesEveryForm) {
  for (const Form form : forms)
    EXPECT_EQ(corners_of(read(one_tetrahedron(), form)), corners_of(tetrahedron()));
}

TEST_F(ReadGltf, TakesIndicesOfEveryWidthAndNone) {
  Gltf gltf = one_tetrahedron();
  const auto corners = [](auto number) {
    std::vector<decltype(number)> all;
    for (const auto& triangle : tetrahedron().polygons)
      all.insert(all.end(), triangle.begin(), triangle.end());
    return all;
  };
  Json& primitive = gltf.json["meshes"][0]["primitives"][0];
  for (const int indices :
       {gltf.indices(corners(std::uint8_t())), gltf.indices(corners(std::uint16_t())),
        gltf.indices(corners(std::uint32_t()))}) {
    primitive["indices"] = indices;
    EXPECT_EQ(corners_of(read(gltf)), corners_of(tetrahedron()));
  }
  primitive.erase("indices");
  primitive["attributes"]["POSITION"] = gltf.positions(corners_of(tetrahedron()));
  EXPECT_EQ(corners_of(read(gltf)), corners_of(tetrahedron()));
}

TEST_F(ReadGltf, TurnsAllTrianglesOfAStripTheSameWay) {
  const Points zigzag = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {2, 0, 0}};
  Gltf gltf;
  const int points = gltf.positions(zigzag);
  gltf.mesh({{{"attributes", {{"POSITION", points}}}, {"mode", 5}}});
  gltf.scene({gltf.node({{"mesh", 0}})});
  const Points c = corners_of(read(gltf));
  ASSERT_EQ(c.size(), 9u);
  for (std::size_t i = 0; i < 9; i += 3)
    EXPECT_EQ((c[i + 1] - c[i]).cross(c[i + 2] - c[i]), Vec3(0, 0, -1)) << i;
}

TEST_F(ReadGltf, LeavesOutTheFlatTrianglesThatJoinStrips) {
  Gltf gltf;
  const int points =
      gltf.positions({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}});
  const int strip = gltf.indices(std::vector<std::uint8_t>{0, 1, 2, 2, 3, 3, 4, 5});
  gltf.mesh({{{"attributes", {{"POSITION", points}}}, {"indices", strip}, {"mode", 5}}});
  gltf.scene({gltf.node({{"mesh", 0}})});
  EXPECT_EQ(corners_of(read(gltf)),
            (Points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 0, 0}, {5, 1, 0}, {6, 0, 0}}));
}

TEST_F(ReadGltf, OpensFansWithAndWithoutIndices) {
  const Points rim = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const Points expected = {rim[0], rim[1], rim[2], rim[0], rim[2], rim[3]};
  Gltf gltf;
  const int points = gltf.positions(rim);
  gltf.mesh({{{"attributes", {{"POSITION", points}}}, {"mode", 6}}});
  gltf.scene({gltf.node({{"mesh", 0}})});
  EXPECT_EQ(corners_of(read(gltf)), expected);
  gltf.json["meshes"][0]["primitives"][0]["indices"] =
      gltf.indices(std::vector<std::uint16_t>{0, 1, 2, 3});
  EXPECT_EQ(corners_of(read(gltf)), expected);
}

TEST_F(ReadGltf, PicksPositionsOutOfInterleavedData) {
  Gltf gltf;
  std::vector<float> mixed = {-1};  // an offset of one float, then position and normal in turn
  const Points corners = corners_of(tetrahedron());
  for (const Vec3& p : corners)
    for (const double x : {p.x(), p.y(), p.z(), 9.0, 9.0, 9.0})
      mixed.push_back(static_cast<float>(x));
  mixed.resize(mixed.size() - 2);  // the last element need not fill its step
  const int points = gltf.accessor(gltf.view(raw(mixed), 24), corners.size(), "VEC3", 5126);
  gltf.json["accessors"][points]["byteOffset"] = 4;
  gltf.mesh({{{"attributes", {{"POSITION", points}}}}});
  gltf.scene({gltf.node({{"mesh", 0}})});
  for (const Form form : forms) EXPECT_EQ(corners_of(read(gltf, form)), corners);
}

TEST_F(ReadGltf, PlacesMeshesByTheirNodesAndAllAbove) {
  const Eigen::Affine3d above = Eigen::Translation3d(1, 2, 3) *
                                Eigen::AngleAxisd(0.7, Vec3(1, 2, 2) / 3) *
                                Eigen::Scaling(Vec3(2, 3, 0.5));
  const Eigen::Affine3d below =
      Eigen::Translation3d(-4, 0, 1) * Eigen::AngleAxisd(-2, Vec3::UnitY()) * Eigen::Scaling(1.5);
  const Quat turn(Eigen::AngleAxisd(0.7, Vec3(1, 2, 2) / 3));
  const Eigen::Matrix4d& m = below.matrix();
  Gltf gltf;
  gltf.mesh(tetrahedron());
  const int child =
      gltf.node({{"mesh", 0}, {"matrix", std::vector<double>(m.data(), m.data() + 16)}});
  const int parent = gltf.node({{"translation", {1, 2, 3}},
                                {"rotation", {turn.x(), turn.y(), turn.z(), turn.w()}},
                                {"scale", {2, 3, 0.5}},
                                {"children", {child}}});
  gltf.scene({parent});
  for (const Form form : forms)
    expect_near(corners_of(read(gltf, form)), moved(corners_of(tetrahedron()), above * below));
}

TEST_F(ReadGltf, TakesARotationOfAnyLength) {
  Gltf gltf = one_tetrahedron();
  for (const double length : {1.0, 1.0003, 50.0, 1e-30, 1e30}) {
    gltf.json["nodes"][0]["rotation"] = {0, 0, std::sqrt(0.5) * length, std::sqrt(0.5) * length};
    expect_near(corners_of(read(gltf)),
                moved(corners_of(tetrahedron()),
                      Eigen::Affine3d(Eigen::AngleAxisd(pi / 2, Vec3::UnitZ()))));
  }
}

TEST_F(ReadGltf, KeepsTheOutsideOfMirroredMeshesOutside) {
  Gltf gltf = one_tetrahedron();
  for (const double x : {2.0, -2.0}) {
    gltf.json["nodes"][0]["scale"] = {x, 3, 4};
    EXPECT_NEAR(volume(read(gltf)), 4, single);
  }
}

TEST_F(ReadGltf, ShowsAMeshWhereverANodeHasIt) {
  Gltf gltf = one_tetrahedron();
  PolygonSoup second = tetrahedron();
  for (Vec3& point : second.points) point *= 2;
  const int bigger = gltf.mesh(second);
  const int again = gltf.node({{"mesh", 0}, {"translation", {5, 0, 0}}});
  const int other = gltf.node({{"mesh", bigger}, {"translation", {0, 7, 0}}});
  gltf.json["scenes"][0]["nodes"] = {0, again, other};
  const PolygonSoup soup = read(gltf);
  EXPECT_EQ(soup.polygons.size(), 12u);
  EXPECT_EQ(soup.points.size(), 12u);
  EXPECT_NEAR(volume(soup), (1 + 1 + 8) / 6.0, single);
}

TEST_F(ReadGltf, ShowsTheDefaultSceneAlone) {
  Gltf gltf = one_tetrahedron();
  const int far = gltf.node({{"mesh", 0}, {"translation", {9, 0, 0}}});
  gltf.scene({far});
  const Points here = corners_of(tetrahedron());
  const Points there = moved(here, Eigen::Affine3d(Eigen::Translation3d(9, 0, 0)));
  EXPECT_EQ(corners_of(read(gltf)), here) << "the first scene when none is named";
  gltf.json["scene"] = 1;
  EXPECT_EQ(corners_of(read(gltf)), there);
  gltf.json.erase("scene");
  gltf.json.erase("scenes");
  EXPECT_EQ(read(gltf).polygons.size(), 8u) << "every node when there is no scene";
}

TEST_F(ReadGltf, PutsASkinnedMeshWhereItsTopmostJointWasBound) {
  Gltf gltf = one_tetrahedron();
  const Eigen::Affine3d inverse =
      Eigen::Translation3d(0, 0, -2) * Eigen::AngleAxisd(pi, Vec3::UnitX());
  gltf.json["skins"] = {{{"joints", {1}}, {"inverseBindMatrices", gltf.matrices({inverse})}}};
  gltf.json["nodes"][0].update({{"skin", 0}, {"translation", {3, 0, 0}}});
  gltf.node({{"rotation", {1, 0, 0, 0}}, {"translation", {0, 0, -2}}});
  const int parent = gltf.node({{"scale", {-7, 7, 7}}, {"children", {0}}});
  gltf.json["scenes"][0]["nodes"] = {1, parent};
  expect_near(corners_of(read(gltf)), corners_of(tetrahedron()));
  gltf.json["nodes"][0].erase("translation");
  gltf.json["nodes"][0]["matrix"] = {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 5, 5, 5, 1};
  expect_near(corners_of(read(gltf)), corners_of(tetrahedron()));
}

TEST_F(ReadGltf, ScalesASkinnedMeshAsItsJointsAre) {
  Gltf gltf = one_tetrahedron();  // in centimeters, below a node that makes them meters
  gltf.json["skins"] = {{{"joints", {1}}}};
  gltf.json["nodes"][0]["skin"] = 0;
  const int joint = gltf.node({{"translation", {100, 0, 0}}});
  gltf.json["scenes"][0]["nodes"] = {
      0, gltf.node({{"scale", {0.01, 0.01, 0.01}}, {"children", {joint}}})};
  expect_near(corners_of(read(gltf)),
              moved(corners_of(tetrahedron()),
                    Eigen::Translation3d(1, 0, 0) * Eigen::Affine3d(Eigen::Scaling(0.01))));
}

TEST_F(ReadGltf, LeavesOutPointsLinesAndVerticesOfNoTriangle) {
  Gltf gltf;
  const int points = gltf.positions({{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {8, 8, 8}});
  const int corners = gltf.indices(std::vector<std::uint8_t>{1, 2, 3});
  std::vector<Json> primitives;
  for (int mode = 0; mode <= 4; ++mode)
    primitives.push_back(
        {{"attributes", {{"POSITION", points}}}, {"indices", corners}, {"mode", mode}});
  primitives.push_back({{"attributes", Json::object()}});
  gltf.mesh(primitives);
  gltf.scene({gltf.node({{"mesh", 0}})});
  const PolygonSoup soup = read(gltf);
  EXPECT_EQ(soup.points, (Points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(soup.polygons, (std::vector<std::vector<int>>{{0, 1, 2}}));
}

TEST_F(ReadGltf, PutsSparsePositionsOverTheOthers) {
  Gltf gltf = one_tetrahedron();
  const int at = gltf.view(raw(std::vector<std::uint16_t>{3}));
  const int value = gltf.view(raw(Points{{0, 0, 5}}));
  gltf.json["accessors"][0]["sparse"] = {{"count", 1},
                                         {"indices", {{"bufferView", at}, {"componentType", 5123}}},
                                         {"values", {{"bufferView", value}}}};
  PolygonSoup expected = tetrahedron();
  expected.points[3].z() = 5;
  for (const Form form : forms) EXPECT_EQ(corners_of(read(gltf, form)), corners_of(expected));
}

TEST_F(ReadGltf, FindsBuffersByEncodedNamesAndBelow) {
  Gltf gltf = one_tetrahedron();
  const auto read_from = [&](const char* uri, const std::string& name, const std::string& more) {
    std::filesystem::create_directories((folder / name).parent_path());
    put(folder / name, gltf.bytes + more);
    gltf.json["buffers"] = {{{"byteLength", gltf.bytes.size()}, {"uri", uri}}};
    EXPECT_EQ(corners_of(read(gltf)), corners_of(tetrahedron())) << uri;
  };
  read_from("my%20mesh%2ebin", "my mesh.bin", "");
  read_from("K%C3%B6rper.bin", "K\u00f6rper.bin", "");
  read_from("100%.bin", "100%.bin", "");
  read_from("data/./deep/../mesh.bin", "data/mesh.bin", "bytes beyond the buffer's length");
}

TEST_F(ReadGltf, TakesASecondBufferBesideAGlbsOwn) {
  Gltf gltf = one_tetrahedron();
  put(folder / "corners.bin", gltf.bytes.substr(48));
  gltf.json["buffers"] = {{{"byteLength", 48}}, {{"byteLength", 48}, {"uri", "corners.bin"}}};
  gltf.json["bufferViews"][1] = {{"buffer", 1}, {"byteLength", 48}};
  gltf.bytes.resize(48);
  EXPECT_EQ(corners_of(read(gltf, Form::packed)), corners_of(tetrahedron()));
}

TEST_F(ReadGltf, AsksForNothingThatAShapeDoesNotNeed) {
  Gltf gltf = one_tetrahedron();
  gltf.json["images"] = {{{"uri", "missing.png"}}, {{"uri", "data:image/png;base64,AAAA"}}};
  gltf.json["textures"] = {{{"source", 0}}};
  gltf.json["cameras"] = {{{"type", "none"}}};
  gltf.json["animations"] = {{{"channels", Json::array()}, {"samplers", Json::array()}}};
  gltf.json["extensionsRequired"] = {"KHR_materials_unlit", "KHR_texture_transform"};
  gltf.json["extensionsUsed"] = {"KHR_materials_unlit", "KHR_texture_transform", "X_own"};
  gltf.json["meshes"][0]["primitives"][0]["material"] = 77;
  testing::internal::CaptureStderr();
  EXPECT_EQ(corners_of(read(gltf)), corners_of(tetrahedron()));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(ReadGltf, TakesExtensionsInAnyCase) {
  std::filesystem::rename(write(folder, one_tetrahedron(), Form::packed), folder / "MESH.GLB");
  EXPECT_EQ(corners_of(read_gltf(folder / "MESH.GLB")), corners_of(tetrahedron()));
}

TEST_F(ReadGltf, TakesAFileFromTheCurrentFolder) {
  write(folder, one_tetrahedron(), Form::beside);
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder);
  EXPECT_EQ(corners_of(read_gltf("mesh.gltf")), corners_of(tetrahedron()));
  std::filesystem::current_path(before);
}

}  // namespace sinew::gltf_test
