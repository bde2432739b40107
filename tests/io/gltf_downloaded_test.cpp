// SPDX-License-Identifier: GPL-3.0-or-later
// glTF as other programs export it: quantized, morphed, bound several times or unevenly.
#include <sinew/io/gltf/geometry.h>
#include <sinew/io/gltf/rig.h>
#include <sinew/rig/motion.h>

#include "io/gltf_rigs.h"
#include "support/expect_error.h"

namespace sinew::gltf_downloaded_test {

using namespace gltf_files;
using test::expect_bad_input;

constexpr double single = 1e-6;  // what single precision leaves of lengths of meters, and of turns

class DownloadedGltf : public Scratch {
 protected:
  SkinnedRig read(const Gltf& gltf, Form form = Form::packed) const {
    return read_gltf_rig(write(folder, gltf, form));
  }
  PolygonSoup mesh(const Gltf& gltf) const { return read_gltf(write(folder, gltf, Form::packed)); }
};

Pose pose_of(const SkinnedRig& rig, double time) {
  return pose_at(rig.rig.skeleton, rig.rig.clips.at(0).motion, time);
}

Points bent(const SkinnedRig& rig, double time) { return skinned_corners(rig, pose_of(rig, time)); }

void expect_near(const Points& points, const Points& expected, double within = single) {
  ASSERT_EQ(points.size(), expected.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_LT((points[i] - expected[i]).norm(), within) << i << ": " << points[i].transpose();
}

Json& attributes_of(Gltf& gltf) { return gltf.json["meshes"][0]["primitives"][0]["attributes"]; }

TEST_F(DownloadedGltf, ReadsQuantizedPositions) {
  const auto with = [&](auto most, int component, bool normalized) {
    using Number = decltype(most);
    std::vector<Number> numbers;
    for (const Vec3& point : tetrahedron().points)
      for (const double x : {point.x(), point.y(), point.z(), 0.0})  // four of them: aligned
        numbers.push_back(static_cast<Number>(x * most));
    Gltf gltf = one_tetrahedron();
    const int view = gltf.view(raw(numbers), 4 * static_cast<int>(sizeof most));
    attributes_of(gltf)["POSITION"] = gltf.accessor(view, 4, "VEC3", component);
    gltf.json["accessors"].back()["normalized"] = normalized;
    gltf.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    const double scale = normalized ? 1 : 1.0 / most;
    gltf.json["nodes"][0]["scale"] = {scale, scale, scale};
    expect_near(mesh(gltf).points, mesh(one_tetrahedron()).points);
  };
  for (const bool normalized : {true, false}) {
    with(std::int8_t{127}, 5120, normalized);
    with(std::uint8_t{255}, 5121, normalized);
    with(std::int16_t{32767}, 5122, normalized);
    with(std::uint16_t{65535}, 5123, normalized);
  }
}

TEST_F(DownloadedGltf, ReadsVrm) {
  Gltf gltf = bending_bar();
  gltf.json["extensionsUsed"] = gltf.json["extensionsRequired"] = {"VRMC_vrm"};
  const auto glb = write(folder, gltf, Form::packed);
  std::filesystem::rename(glb, folder / "figure.vrm");
  EXPECT_EQ(read_gltf_rig(folder / "figure.vrm").rig.skeleton.size(), 2u);
}

TEST_F(DownloadedGltf, PutsMorphTargetsWhereTheyRest) {
  Gltf gltf = one_tetrahedron();
  const int up = gltf.positions(Points(4, Vec3(0, 0, 2))),
            aside = gltf.positions(Points(4, {4, 0, 0}));
  Json& shape = gltf.json["meshes"][0];
  shape["primitives"][0]["targets"] = {{{"POSITION", up}}, {{"POSITION", aside}}, Json::object()};
  const auto shift = [&] { return Vec3(mesh(gltf).points[0] - mesh(one_tetrahedron()).points[0]); };
  EXPECT_EQ(shift(), Vec3(0, 0, 0));
  shape["weights"] = {0.5, 0, 1};
  EXPECT_EQ(shift(), Vec3(0, 0, 1));
  gltf.json["nodes"][0]["weights"] = {0, 0.25, 0};
  EXPECT_EQ(shift(), Vec3(1, 0, 0)) << "the node's in place of the mesh's";
  EXPECT_EQ(mesh(gltf).warning, "");
  shape["primitives"][0]["targets"][0]["POSITION"] = gltf.positions({{0, 0, 0}});
  expect_bad_input([&] { mesh(gltf); }, {"morph targets have 1 of 4 points"});
}

TEST_F(DownloadedGltf, TellsOfMorphTargetsThatMove) {
  Gltf gltf = bending_bar();
  const int times = gltf.floats({0, 1}, "SCALAR");
  add_channel(gltf, 0, 3, "weights", "LINEAR", times, gltf.floats({0, 1}, "SCALAR"));
  EXPECT_NE(mesh(gltf).warning.find("morph targets, which are not read"), std::string::npos);
}

/// The bar with a second mesh, a point with one joint, whose own skin binds the joints elsewhere.
TEST_F(DownloadedGltf, CarriesMeshesBoundInAnotherPoseToTheFirst) {
  Gltf gltf = bending_bar();
  // Bound with the upper bone turned by 90 degrees about y: what pointed along x points along z.
  const Affine turned =
      Eigen::Translation3d(0, 0, 1) * Affine(Eigen::AngleAxisd(pi / 2, Vec3::UnitY()));
  const int skin = gltf.add(
      "skins", {{"joints", {0, 1}},
                {"inverseBindMatrices", gltf.matrices({Affine::Identity(), turned.inverse()})}});
  gltf.json["scenes"][0]["nodes"].push_back(gltf.node({{"mesh", 0}, {"skin", skin}}));
  const SkinnedRig rig = read(gltf);
  const std::size_t half = rig.mesh.points.size() / 2;
  for (std::size_t i = 0; i < half; ++i) {
    const Vec3& place = rig.mesh.points[i];
    const double upper = place.z() / 2;
    const Vec3 by_upper = Vec3(0, 0, 1) + turned.linear().transpose() * (place - Vec3(0, 0, 1));
    EXPECT_LT((rig.mesh.points[half + i] - (1 - upper) * place - upper * by_upper).norm(), single);
  }
  EXPECT_EQ(read_gltf(folder / "mesh.glb").points, rig.mesh.points);
}

TEST_F(DownloadedGltf, TellsOfUnevenScale) {
  Gltf gltf = bending_bar();
  gltf.json["nodes"][0]["scale"] = {1, 1, 1.25};
  const SkinnedRig rig = read(gltf);
  ASSERT_EQ(rig.rig.warnings.size(), 1u);
  EXPECT_NE(rig.rig.warnings[0].find("2 of 2 joints are bound with uneven scale, joint 'lower' "
                                     "(node 0) by 25 %"),
            std::string::npos)
      << rig.rig.warnings[0];
  EXPECT_LT((rig.rig.skeleton.bones[1].tail() - Vec3(0, 0, 2.5)).norm(), single);
  EXPECT_LT((pose_of(rig, 0)[1].turn - Mat3::Identity()).norm(), single);
  EXPECT_LT((pose_of(rig, 1)[1].frame.origin - Vec3(0, 0, 1.25)).norm(), single);
  EXPECT_GT(std::abs(Eigen::AngleAxisd(pose_of(rig, 1)[1].turn).angle()), 1);
}

TEST_F(DownloadedGltf, MovesMirroredSkeletonsAsTheirImages) {
  const SkinnedRig whole = read(bending_bar());
  Gltf gltf = bending_bar();
  gltf.json["scenes"][0]["nodes"] = {gltf.node({{"scale", {-1, 1, 1}}, {"children", {0}}}), 3};
  const SkinnedRig rig = read(gltf);
  EXPECT_TRUE(rig.rig.warnings.empty());
  for (const double time : {0.0, 0.4, 1.0}) {
    Points expected = bent(whole, time), points = bent(rig, time);
    for (std::size_t i = 0; i < points.size(); i += 3) std::swap(points[i + 1], points[i + 2]);
    for (Vec3& point : expected) point.x() = -point.x();
    expect_near(points, expected);
  }
}

TEST_F(DownloadedGltf, BindsSkinsWithoutBindMatricesWhereNodesRest) {
  Gltf gltf = bending_bar();
  std::vector<float> whole;  // each vertex in the space of the one joint that it follows
  for (int i = 0; i < 15; ++i)
    whole.insert(whole.end(), {i < 6 ? 1.F : 0.F, i < 6 ? 0.F : 1.F, 0, 0});
  attributes_of(gltf)["WEIGHTS_0"] = gltf.floats(whole, "VEC4");
  const SkinnedRig bound = read(gltf);
  Points points;
  for (const double z : {0.0, 0.5, 0.0, 0.5, 1.0})
    for (const Vec3& corner : {Vec3(0.1, 0, z), Vec3(-0.1, 0.1, z), Vec3(-0.1, -0.1, z)})
      points.push_back(corner);
  attributes_of(gltf)["POSITION"] = gltf.positions(points);
  gltf.json["skins"][0].erase("inverseBindMatrices");
  for (const double time : {0.0, 1.0}) expect_near(bent(read(gltf), time), bent(bound, time));
}

TEST_F(DownloadedGltf, TakesTwoKeysAtOneTimeForAJump) {
  Gltf gltf = bar();
  const auto turned = [](double angle) { return Quat(Eigen::AngleAxisd(angle, Vec3::UnitY())); };
  add_keys<Quat>(gltf, 1, "rotation", "LINEAR", {0, 1, 1, 1, 2},
                 {turned(0), turned(0.2), turned(3), turned(1), turned(1.5)});
  const SkinnedRig rig = read(gltf);
  const auto angle = [&](double time) {
    return Eigen::AngleAxisd(pose_of(rig, time)[1].turn).angle();
  };
  EXPECT_NEAR(angle(0.5), 0.1, 1e-4);
  EXPECT_NEAR(angle(0.999), 0.2, 1e-3);
  EXPECT_NEAR(angle(1), 1, single);
  EXPECT_NEAR(angle(1.5), 1.25, single);
}

TEST_F(DownloadedGltf, RefusesWhatChangesShapesByName) {
  Gltf gltf = bending_bar();
  gltf.json["extensionsUsed"] = {"X_unknown"};
  EXPECT_EQ(read(gltf).rig.skeleton.size(), 2u) << "not required";
  gltf.json["extensionsRequired"] = {"KHR_meshopt_compression"};
  expect_bad_input([&] { read(gltf); }, {"'KHR_meshopt_compression'", "without mesh compression"});
}

}  // namespace sinew::gltf_downloaded_test
