// SPDX-License-Identifier: GPL-3.0-or-later
// glTF as characters are made: rigid meshes below joints, animated nodes, clips in files of their
// own.
#include <sinew/io/gltf/geometry.h>
#include <sinew/io/gltf/rig.h>
#include <sinew/rig/motion.h>

#include <set>

#include "io/gltf_rigs.h"
#include "support/expect_error.h"

namespace sinew::gltf_characters_test {

using namespace gltf_files;
using test::expect_bad_input;

constexpr double single = 1e-6;  // what single precision leaves of lengths of meters, and of turns

class GltfCharacter : public Scratch {
 protected:
  std::filesystem::path put(const Gltf& gltf, const std::string& name = "mesh.glb") const {
    const auto path = write(folder, gltf, Form::packed);
    if (name != "mesh.glb") std::filesystem::rename(path, folder / name);
    return folder / name;
  }
  SkinnedRig read(const Gltf& gltf) const { return read_gltf_rig(put(gltf)); }
};

Pose pose_of(const SkinnedRig& rig, double time, std::size_t clip = 0) {
  return pose_at(rig.rig.skeleton, rig.rig.clips.at(clip).motion, time);
}

Quat about_y(double angle) { return Quat(Eigen::AngleAxisd(angle, Vec3::UnitY())); }

/// The corners of the tetrahedron where a transform puts them.
Points corners_at(const Affine& place) {
  Points corners;
  for (const auto& face : tetrahedron().polygons)
    for (const int corner : face)
      corners.push_back(place * tetrahedron().points[static_cast<std::size_t>(corner)]);
  return corners;
}

void expect_ends_with(const Points& points, const Points& expected) {
  ASSERT_GE(points.size(), expected.size());
  const std::size_t first = points.size() - expected.size();
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_LT((points[first + i] - expected[i]).norm(), single) << points[first + i].transpose();
}

TEST_F(GltfCharacter, ASingleBoneEndsWithItsFlesh) {
  Gltf gltf;
  const int mesh = gltf.mesh(tetrahedron());
  const std::vector<std::uint8_t> joints(16, 0);
  std::vector<float> weights(16, 0);
  for (std::size_t i = 0; i < 16; i += 4) weights[i] = 1;
  Json& attributes = gltf.json["meshes"][mesh]["primitives"][0]["attributes"];
  attributes["JOINTS_0"] = gltf.accessor(gltf.view(raw(joints)), 4, "VEC4", 5121);
  attributes["WEIGHTS_0"] = gltf.floats(weights, "VEC4");
  gltf.node({{"name", "bone"}});
  gltf.node({{"mesh", mesh}, {"skin", 0}});
  gltf.scene({0, 1});
  gltf.add("skins", {{"joints", {0}}});
  const Skeleton skeleton = read(gltf).rig.skeleton;
  ASSERT_EQ(skeleton.size(), 1u);
  Box box;
  for (const Vec3& point : tetrahedron().points) box.extend(point);
  EXPECT_LT((skeleton.bones[0].tail() - 2 * box.center()).norm(), single);
}

/// The bending bar, whose upper joint stands otherwise at rest than bound, and holds a tetrahedron.
Gltf armed_bar() {
  Gltf gltf = bending_bar();
  gltf.json["nodes"][1]["rotation"] = numbers(about_y(0.5));
  const int grip = gltf.node({{"translation", {0, 0, 0.5}}});
  gltf.json["nodes"][1]["children"].push_back(grip);
  const int sword = gltf.node(
      {{"name", "sword"}, {"mesh", gltf.mesh(tetrahedron())}, {"translation", {0.25, 0, 0}}});
  gltf.json["nodes"][grip]["children"] = {sword};
  return gltf;
}

TEST_F(GltfCharacter, NamesTheMeshesThatItShows) {
  const auto names = gltf_mesh_names(put(armed_bar()));
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()),
            (std::set<std::string>{"body", "sword"}));
  Gltf clip = bending_bar();
  clip.json.erase("meshes"), clip.json.erase("skins"), clip.json["nodes"].erase(3);
  clip.json["scenes"][0]["nodes"] = {0};
  EXPECT_EQ(gltf_mesh_names(put(clip)).size(), 0u);
}

TEST_F(GltfCharacter, BindsRigidMeshesToTheJointAboveThem) {
  const SkinnedRig rig = read(armed_bar());
  ASSERT_EQ(rig.rig.skeleton.size(), 2u);
  const Affine held(Eigen::Translation3d(0.25, 0, 1.5));
  Points corners;
  for (const auto& face : rig.mesh.polygons)
    for (const int corner : face)
      corners.push_back(rig.mesh.points[static_cast<std::size_t>(corner)]);
  expect_ends_with(corners, corners_at(held));
  EXPECT_EQ(read_gltf(folder / "mesh.glb").points, rig.mesh.points) << "the body, the same";
  for (const double time : {0.0, 0.5, 1.0}) {
    const Affine turn =
        Eigen::Translation3d(0, 0, 1) * about_y(pi / 2 * time) * Eigen::Translation3d(0.25, 0, 0.5);
    expect_ends_with(skinned_corners(rig, pose_of(rig, time)), corners_at(turn));
  }
}

TEST_F(GltfCharacter, MovesRigidMeshesByNodesOfTheirOwn) {
  Gltf gltf = armed_bar();
  const int sword = static_cast<int>(gltf.json["nodes"].size()) - 1;
  gltf.json["nodes"][sword]["name"] = "sword";
  add_keys<Quat>(gltf, sword, "rotation", "LINEAR", {0, 1}, {about_y(0), about_y(1)});
  const SkinnedRig rig = read(gltf);
  ASSERT_EQ(rig.rig.skeleton.size(), 3u);
  EXPECT_EQ(rig.rig.skeleton.bones[2].name, "sword");
  EXPECT_EQ(rig.rig.skeleton.bones[2].parent, 1);
  const Affine turn = Eigen::Translation3d(0, 0, 1) * about_y(pi / 4) *
                      Eigen::Translation3d(0.25, 0, 0.5) * Affine(about_y(0.5));
  expect_ends_with(skinned_corners(rig, pose_of(rig, 0.5)), corners_at(turn));
}

/// A base that stands still, on which an arm with a hand turns; no skin.
Gltf robot() {
  Gltf gltf;
  const int mesh = gltf.mesh(tetrahedron());
  gltf.node({{"name", "base"}, {"mesh", mesh}, {"children", {1}}});
  gltf.node({{"name", "arm"}, {"mesh", mesh}, {"translation", {0, 0, 2}}, {"children", {2}}});
  gltf.node({{"name", "hand"}, {"mesh", mesh}, {"translation", {0, 0, 2}}});
  gltf.scene({0});
  add_keys<Quat>(gltf, 1, "rotation", "LINEAR", {0, 1}, {about_y(0), about_y(1)});
  return gltf;
}

TEST_F(GltfCharacter, MakesBonesOfAnimatedNodes) {
  const SkinnedRig rig = read(robot());
  EXPECT_TRUE(has_gltf_rig(folder / "mesh.glb"));
  ASSERT_EQ(rig.rig.skeleton.size(), 2u);
  EXPECT_EQ(rig.rig.skeleton.bones[0].name, "base") << "holds what does not move";
  EXPECT_EQ(rig.rig.skeleton.bones[1].name, "arm");
  ASSERT_EQ(rig.mesh.points.size(), 12u);
  EXPECT_EQ(rig.weights.of(0)[0].bone, 0);
  EXPECT_EQ(rig.weights.of(4)[0].bone, 1);
  const Affine hand = Eigen::Translation3d(0, 0, 2) * about_y(1) * Eigen::Translation3d(0, 0, 2);
  expect_ends_with(skinned_corners(rig, pose_of(rig, 1)), corners_at(hand));
}

/// Armature of an FBX beside props, with a skin that no mesh uses.
TEST_F(GltfCharacter, HoldsStillMeshesBesideAnArmatureThatMoves) {
  Gltf gltf = robot();
  const int tip = gltf.node({{"name", "tip"}, {"translation", {0, 0, 1}}});
  const int root = gltf.node({{"name", "root"}, {"children", {tip}}});
  gltf.json["scenes"][0]["nodes"].push_back(root);
  gltf.add("skins", {{"joints", {root, tip}}});
  add_keys<Quat>(gltf, root, "rotation", "LINEAR", {0, 1}, {about_y(0), about_y(1)});
  const SkinnedRig rig = read(gltf);
  const std::vector<Bone>& bones = rig.rig.skeleton.bones;
  ASSERT_EQ(bones.size(), 4u);
  EXPECT_EQ(bones[static_cast<std::size_t>(rig.weights.of(0)[0].bone)].name, "base");
  EXPECT_EQ(bones[static_cast<std::size_t>(rig.weights.of(4)[0].bone)].name, "arm");
}

/// A mesh without weights beside an armature of its place, as of an FBX whose skin was not written.
TEST_F(GltfCharacter, LeavesMeshesWithoutWeightsBesideBareJoints) {
  Gltf gltf = robot();
  gltf.json.erase("animations");
  const int tip = gltf.node({{"name", "tip"}, {"translation", {0, 0, 1}}});
  const int root = gltf.node({{"name", "root"}, {"children", {tip}}});
  gltf.json["scenes"][0]["nodes"].push_back(root);
  gltf.add("skins", {{"joints", {root, tip}}});
  const SkinnedRig rig = read(gltf);
  EXPECT_EQ(rig.rig.skeleton.size(), 2u);
  EXPECT_TRUE(rig.weights.weights.empty());
}

/// An avatar without a skin or a clip, in the words of both versions of VRM.
TEST_F(GltfCharacter, MakesBonesOfTheNodesThatVrmNames) {
  const Json list = {{{"bone", "hips"}, {"node", 0}},
                     {{"bone", "spine"}, {"node", 1}},
                     {{"bone", "head"}, {"node", 2}},
                     {{"bone", "jaw"}, {"node", 99}}};
  const Json named = {{"hips", {{"node", 0}}}, {"spine", {{"node", 1}}}, {"head", {{"node", 2}}}};
  for (const auto& [extension, bones] : {std::pair{"VRM", list}, {"VRMC_vrm", named}}) {
    Gltf gltf = robot();
    gltf.json.erase("animations");
    gltf.json["extensions"][extension]["humanoid"]["humanBones"] = bones;
    const SkinnedRig rig = read(gltf);
    ASSERT_EQ(rig.rig.skeleton.size(), 3u) << extension;
    EXPECT_EQ(rig.rig.skeleton.bones[2].name, "hand");
    EXPECT_EQ(rig.rig.skeleton.bones[2].parent, 1);
    EXPECT_EQ(rig.weights.of(8)[0].bone, 2);
  }
}

TEST_F(GltfCharacter, JoinsUnnamedClipsOfOneLength) {
  Gltf gltf = robot();
  add_keys<Quat>(gltf, 2, "rotation", "LINEAR", {0, 1}, {about_y(0), about_y(2)}, 1);
  EXPECT_EQ(read(gltf).rig.clips.size(), 2u);
  for (Json& animation : gltf.json["animations"]) animation.erase("name");
  const SkinnedRig rig = read(gltf);
  ASSERT_EQ(rig.rig.clips.size(), 1u);
  EXPECT_LT((pose_of(rig, 1)[2].turn - about_y(3).toRotationMatrix()).norm(), single);
  add_keys<Quat>(gltf, 2, "rotation", "LINEAR", {0, 1}, {about_y(0), about_y(2)}, 2);
  gltf.json["animations"][2].erase("name");
  EXPECT_EQ(read(gltf).rig.clips.size(), 2u) << "moves a node of the first again";
  gltf.json["animations"][1]["samplers"][0]["input"] = gltf.floats({0, 3}, "SCALAR");
  EXPECT_EQ(read(gltf).rig.clips.size(), 2u) << "of another length";
}

TEST_F(GltfCharacter, TakesScaleFromJointsBelowARootOutsideOfIt) {
  Gltf gltf = bending_bar();  // in centimeters below an armature that makes them meters
  const int armature = gltf.node({{"scale", {0.01, 0.01, 0.01}}, {"children", {0}}});
  const int root = gltf.node({{"name", "_rootJoint"}, {"children", {armature}}});
  const Affine upper(Eigen::Translation3d(0, 0, -1));
  gltf.json["skins"][0] = {
      {"joints", {0, 1, root}},
      {"inverseBindMatrices", gltf.matrices({Affine::Identity(), upper, Affine::Identity()})}};
  gltf.json["scenes"][0]["nodes"] = {root, 3};
  const Skeleton skeleton = read(gltf).rig.skeleton;
  ASSERT_EQ(skeleton.size(), 3u);
  EXPECT_LT((skeleton.bones[2].tail() - Vec3(0, 0, 0.02)).norm(), single);
  Box box;
  for (const Vec3& point : read(gltf).mesh.points) box.extend(point);
  EXPECT_NEAR(box.sizes().z(), 0.02, single);
}

TEST_F(GltfCharacter, TakesClipsByNamesOfNodesFromOtherFiles) {
  const auto character = put(armed_bar(), "character.glb");
  Gltf clip;  // without a skin, and resting as its first frame is
  clip.node({{"name", "hips"}, {"children", {1}}});
  clip.node({{"name", "lower"}, {"children", {2}}});
  clip.node({{"name", "upper"}, {"translation", {0, 0, 1.5}}, {"rotation", numbers(about_y(1))}});
  clip.scene({0});
  add_keys<Quat>(clip, 0, "rotation", "LINEAR", {0, 2}, {about_y(0), about_y(1)});
  add_keys<Quat>(clip, 2, "rotation", "LINEAR", {0, 2}, {about_y(1), about_y(2)});
  add_keys<Vec3>(clip, 2, "translation", "LINEAR", {0, 2}, {{0, 0, 1.5}, {0, 0, 1.5}});
  SkinnedRig rig = read_gltf_rig(character);
  rig.rig = read_gltf_clips(character, put(clip, "clip.glb"));
  ASSERT_EQ(rig.rig.clips.size(), 1u);
  const Pose pose = pose_of(rig, 1);
  EXPECT_LT((pose[1].turn - about_y(1.5).toRotationMatrix()).norm(), single);
  EXPECT_LT((pose[1].frame.origin - Vec3(0, 0, 1)).norm(), single) << "the character's own length";
  ASSERT_EQ(rig.rig.warnings.size(), 2u);
  EXPECT_NE(rig.rig.warnings[0].find("moves 1 node that the skeleton lacks: 'hips'"),
            std::string::npos)
      << rig.rig.warnings[0];
  EXPECT_NE(rig.rig.warnings[1].find("does not move 1 of 2 joints: 'lower'"), std::string::npos)
      << rig.rig.warnings[1];
  clip.json["nodes"][2]["name"] = "other";
  expect_bad_input([&] { read_gltf_clips(character, put(clip, "clip.glb")); },
                   {"moves no joint of the skeleton"});
}

TEST_F(GltfCharacter, RefusesAFileWithoutBones) {
  expect_bad_input([&] { read(one_tetrahedron()); },
                   {"it has no skin and no animated nodes", "with its armature"});
  EXPECT_FALSE(has_gltf_rig(folder / "mesh.glb"));
}

}  // namespace sinew::gltf_characters_test
