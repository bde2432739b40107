// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/rig.h>

#include <numeric>

#include <sinew/scene/rig.h>

#include <sinew/io/gltf/geometry.h>
#include <sinew/rig/motion.h>
#include <sinew/rig/motion_checks.h>
#include <sinew/settings/read_scene.h>
#include "io/gltf_rigs.h"
#include "support/expect_error.h"
#include "support/source_dir.h"

namespace sinew::gltf_rig_test {

using namespace gltf_files;
using test::expect_bad_input;

constexpr double single = 1e-6;  // what single precision leaves of lengths of meters, and of turns

class ReadGltfRig : public Scratch {
 protected:
  SkinnedRig read(const Gltf& gltf, Form form = Form::embedded) const {
    return read_gltf_rig(write(folder, gltf, form));
  }
};

Pose pose_of(const SkinnedRig& rig, double time, std::size_t clip = 0) {
  return pose_at(rig.rig.skeleton, rig.rig.clips.at(clip).motion, time);
}

Mat3 about_y(double angle) { return Eigen::AngleAxisd(angle, Vec3::UnitY()).toRotationMatrix(); }

TEST_F(ReadGltfRig, GivesBonesAsBound) {
  for (const Form form : forms) {
    const Skeleton skeleton = read(bending_bar(), form).rig.skeleton;
    ASSERT_EQ(skeleton.size(), 2u);
    EXPECT_EQ(skeleton.bones[0].name, "lower");
    EXPECT_EQ(skeleton.bones[1].name, "upper");
    EXPECT_EQ(skeleton.bones[0].parent, no_bone);
    EXPECT_EQ(skeleton.bones[1].parent, 0);
    EXPECT_EQ(skeleton.bones[0].head(), Vec3(0, 0, 0));
    EXPECT_EQ(skeleton.bones[0].tail(), Vec3(0, 0, 1));
    EXPECT_EQ(skeleton.bones[1].tail(), Vec3(0, 0, 2)) << "the only child of a last joint ends it";
  }
}

TEST_F(ReadGltfRig, EndsBonesAtTheNodesNamedTheirEnds) {
  Gltf gltf = bar();
  Json& nodes = gltf.json["nodes"];
  nodes[0]["children"].push_back(
      gltf.node({{"name", "lower_end"}, {"translation", {0.25, 0, 0.5}}}));
  nodes[1]["children"].push_back(gltf.node({{"name", "hair"}, {"translation", {1, 0, 0}}}));
  nodes[2]["name"] = "upper_end";
  const Skeleton skeleton = read(gltf).rig.skeleton;
  ASSERT_EQ(skeleton.size(), 2u);
  EXPECT_EQ(skeleton.bones[0].tail(), Vec3(0.25, 0, 0.5)) << "not the joint below";
  EXPECT_EQ(skeleton.bones[1].tail(), Vec3(0, 0, 2)) << "not the other child";
}

TEST_F(ReadGltfRig, GivesTheMeshThatReadGltfGives) {
  const auto path = write(folder, bending_bar(), Form::packed);
  const PolygonSoup mesh = read_gltf_rig(path).mesh, expected = read_gltf(path);
  EXPECT_EQ(mesh.points, expected.points);
  EXPECT_EQ(mesh.polygons, expected.polygons);
}

TEST_F(ReadGltfRig, LeavesMeshesWithoutASkinOut) {
  Gltf gltf = bar();
  const int other = gltf.mesh(tetrahedron());
  gltf.json["scenes"][0]["nodes"].push_back(gltf.node({{"mesh", other}}));
  EXPECT_EQ(read(gltf).mesh.polygons.size(), read(bar()).mesh.polygons.size());
}

TEST_F(ReadGltfRig, TakesARigWithoutAMesh) {
  Gltf gltf = bending_bar();
  gltf.json["nodes"][3] = Json::object();
  const SkinnedRig rig = read(gltf);
  EXPECT_EQ(rig.rig.skeleton.size(), 2u);
  EXPECT_EQ(rig.rig.clips.size(), 1u);
  EXPECT_TRUE(rig.mesh.points.empty());
  EXPECT_EQ(rig.weights.first.size(), 1u);
}

TEST_F(ReadGltfRig, TurnsBonesAboutTheirHeads) {
  const SkinnedRig rig = read(bending_bar());
  for (const double time : {0.0, 0.3, 1.0, 7.0}) {
    const Pose pose = pose_of(rig, time);
    EXPECT_LT((pose[1].turn - about_y(pi / 2 * std::min(time, 1.0))).norm(), single) << time;
    EXPECT_LT((pose[1].frame.origin - Vec3(0, 0, 1)).norm(), single) << time;
    EXPECT_EQ(pose[0].turn, Mat3::Identity()) << time;
  }
}

TEST_F(ReadGltfRig, KeepsKeysAndTheWaysBetween) {
  const std::pair<const char*, Interpolation> kinds[] = {{"STEP", Interpolation::step},
                                                         {"LINEAR", Interpolation::linear},
                                                         {"CUBICSPLINE", Interpolation::cubic}};
  for (const auto& [name, interpolation] : kinds) {
    const SkinnedRig rig = read(bending_bar(name));
    ASSERT_EQ(rig.rig.clips.at(0).motion.tracks.size(), 1u) << "a bone at rest has no track";
    const Track& track = rig.rig.clips[0].motion.tracks[0];
    EXPECT_EQ(track.bone, 1);
    EXPECT_EQ(track.rotation.interpolation, interpolation);
    EXPECT_EQ(track.rotation.times, (std::vector<double>{0, 1}));
    EXPECT_EQ(track.rotation.in.size(), interpolation == Interpolation::cubic ? 2u : 0u);
    EXPECT_TRUE(track.translation.empty());
  }
}

TEST_F(ReadGltfRig, TakesRotationsInPartsOfWholeNumbers) {
  const double turn = std::sqrt(0.5);
  const auto with = [&](auto most, int component) {
    using Number = decltype(most);
    Gltf gltf = bar();
    const auto part = static_cast<Number>(std::lround(turn * most));
    const std::vector<Number> values = {0, 0, 0, most, 0, part, 0, part};
    const int output = gltf.accessor(gltf.view(raw(values)), 2, "VEC4", component);
    gltf.json["accessors"][output]["normalized"] = true;
    add_channel(gltf, 0, 1, "rotation", "LINEAR", gltf.floats({0, 1}, "SCALAR"), output);
    return pose_of(read(gltf), 1)[1].turn;
  };
  EXPECT_LT((with(std::int16_t{32767}, 5122) - about_y(pi / 2)).norm(), 1e-4);
  EXPECT_LT((with(std::int8_t{127}, 5120) - about_y(pi / 2)).norm(), 0.02);
  EXPECT_LT((with(std::uint16_t{65535}, 5123) - about_y(pi / 2)).norm(), 1e-4);
  EXPECT_LT((with(std::uint8_t{255}, 5121) - about_y(pi / 2)).norm(), 0.01);
}

TEST_F(ReadGltfRig, FoldsStaticNodesIn) {
  Gltf gltf = bending_bar();
  Json& nodes = gltf.json["nodes"];
  const Quat turn(Eigen::AngleAxisd(-pi / 2, Vec3::UnitX()));  // z up becomes y up
  const int above = gltf.node({{"rotation", numbers(turn)},
                               {"scale", {0.01, 0.01, 0.01}},
                               {"translation", {5, 0, 0}},
                               {"children", {0}}});
  const int between = gltf.node({{"scale", {2, 2, 2}}, {"children", {1}}});
  nodes[0]["children"] = {between};
  nodes[1]["translation"] = {0, 0, 0.5};
  nodes[1]["scale"] = {0.5, 0.5, 0.5};
  gltf.json["scenes"][0]["nodes"] = {above, 3};
  const SkinnedRig rig = read(gltf);
  const Bone& upper = rig.rig.skeleton.bones[1];
  EXPECT_LT((upper.head() - Vec3(5, 0.01, 0)).norm(), single) << upper.head().transpose();
  EXPECT_LT((upper.tail() - Vec3(5, 0.02, 0)).norm(), single) << upper.tail().transpose();
  EXPECT_EQ(rig.rig.clips[0].motion.tracks.size(), 1u);
  EXPECT_EQ(rig.rig.clips[0].motion.tracks[0].rotation.times.size(), 2u) << "no samples";
  EXPECT_LT((pose_of(rig, 1)[1].turn * Vec3::UnitY() - Vec3::UnitX()).norm(), single);
  Box box;
  for (const Vec3& point : rig.mesh.points) box.extend(point);
  EXPECT_LT((box.sizes() - Vec3(0.002, 0.02, 0.002)).norm(), single) << box.sizes().transpose();
}

TEST_F(ReadGltfRig, GivesBonesThatStandOtherwiseThanBoundOneKey) {
  Gltf gltf = bar();
  gltf.json["nodes"][1]["rotation"] = numbers(Quat(Eigen::AngleAxisd(1, Vec3::UnitY())));
  gltf.json["nodes"][1]["translation"] = {0.5, 0, 1};
  gltf.json["animations"] = {Json::object()};
  const SkinnedRig rig = read(gltf);
  EXPECT_LT((rig.rig.skeleton.bones[1].head() - Vec3(0, 0, 1)).norm(), single);
  ASSERT_EQ(rig.rig.clips[0].motion.tracks.size(), 1u);
  const Pose pose = pose_of(rig, 3);
  EXPECT_LT((pose[1].turn - about_y(1)).norm(), single);
  EXPECT_LT((pose[1].frame.origin - Vec3(0.5, 0, 1)).norm(), single);
}

TEST_F(ReadGltfRig, TakesConstantScaleForNoMotion) {
  Gltf gltf = bending_bar();
  add_keys<Vec3>(gltf, 0, "scale", "LINEAR", {0, 1}, {{1, 1, 1}, {1, 1.000001, 1}});
  EXPECT_EQ(read(gltf).rig.clips[0].motion.tracks.at(0).rotation.times.size(), 2u) << "no samples";
  EXPECT_TRUE(read(gltf).rig.clips.at(0).motion.ignored_scales.empty());
}

TEST_F(ReadGltfRig, TellsOfTheScaleThatBonesDoNotFollow) {
  for (const double factor : {0.25, 3.0}) {
    Gltf held = bending_bar();
    add_keys<Vec3>(held, 0, "scale", "LINEAR", {0, 1},
                   {Vec3::Constant(factor), Vec3::Constant(factor)});
    Gltf growing = bending_bar();
    add_keys<Vec3>(growing, 0, "scale", "LINEAR", {0, 1}, {{1, 1, 1}, {1, factor, 1}});
    Gltf units = bending_bar();
    const int above = units.node({{"scale", {factor, factor, factor}}, {"children", {0}}});
    units.json["scenes"][0]["nodes"] = {above, 3};
    const std::vector<bool> all(2, true);
    for (const Gltf* gltf : {&held, &growing}) {
      const Motion motion = read(*gltf).rig.clips.at(0).motion;
      const auto largest = largest_scale(motion, all);
      ASSERT_TRUE(largest);
      EXPECT_EQ(largest->bone, 0);
      EXPECT_NEAR(largest->factor, factor, single * factor);
      EXPECT_FALSE(largest_scale(motion, {false, false})) << "bones without flesh";
    }
    EXPECT_FALSE(largest_scale(read(units).rig.clips.at(0).motion, all));
  }
}

TEST_F(ReadGltfRig, MovesHeadsAsScaleThatChangesMovesThem) {
  Gltf gltf = bending_bar();
  add_keys<Vec3>(gltf, 0, "scale", "LINEAR", {0, 1}, {{1, 1, 1}, {1, 1, 2}});
  const SkinnedRig rig = read(gltf);
  for (const double time : {0.0, 0.5, 1.0})
    EXPECT_LT((pose_of(rig, time)[1].frame.origin - Vec3(0, 0, 1 + time)).norm(), single);
  EXPECT_GT(rig.rig.clips[0].motion.tracks.at(0).rotation.times.size(), 50u);
}

TEST_F(ReadGltfRig, NamesClipsOnceEach) {
  Gltf gltf = bending_bar();
  Json& animations = gltf.json["animations"];
  animations.push_back(animations[0]);
  animations.push_back(animations[0]);
  animations[2].erase("name");
  const auto clips = read(gltf).rig.clips;
  ASSERT_EQ(clips.size(), 3u);
  EXPECT_EQ(clips[0].name, "clip");
  EXPECT_EQ(clips[1].name, "clip_2");
  EXPECT_EQ(clips[2].name, "animation_2");
}

TEST_F(ReadGltfRig, TakesNamesIntoOneLine) {
  Gltf gltf = bending_bar();
  gltf.json["nodes"][0]["name"] = "low\ner\x1b[31m";
  gltf.json["animations"][0]["name"] = "\tclip\x7f";
  const Rig rig = read(gltf).rig;
  EXPECT_EQ(rig.skeleton.bones[0].name, "low?er?[31m");
  EXPECT_EQ(rig.clips[0].name, "?clip?");
}

TEST_F(ReadGltfRig, KnowsDurationAndFrames) {
  const SkinnedRig even = read(bending_bar());
  EXPECT_EQ(even.rig.clips[0].duration, 1);
  EXPECT_EQ(even.rig.clips[0].frames, 2);
  EXPECT_EQ(even.rig.clips[0].frame_time, 1);
  Gltf gltf = bending_bar();
  add_keys<Vec3>(gltf, 0, "translation", "LINEAR", {0.5, 2}, {{0, 0, 0}, {0, 1, 0}});
  EXPECT_EQ(read(gltf).rig.clips[0].duration, 2);
  add_keys<Vec3>(gltf, 1, "translation", "LINEAR", {0.1}, {{0, 0, 1}});
  EXPECT_EQ(read(gltf).rig.clips[0].frames, 0);
  Gltf late = bending_bar();
  late.json["animations"][0]["samplers"][0]["input"] = late.floats({10, 11}, "SCALAR");
  const Clip clip = read(late).rig.clips[0];
  EXPECT_EQ(clip.duration, 1);
  EXPECT_EQ(first_key(clip.motion), 10);
}

TEST_F(ReadGltfRig, TakesSparseJointsOverNothing) {
  const SkinnedRig whole = read(bending_bar());
  Gltf gltf = bending_bar();
  Json& primitive = gltf.json["meshes"][0]["primitives"][0]["attributes"];
  const int joints = primitive["JOINTS_0"];
  const Json was = gltf.json["accessors"][joints];
  std::vector<std::uint8_t> all(was["count"].get<std::size_t>());
  std::iota(all.begin(), all.end(), std::uint8_t{0});
  const int at = gltf.view(raw(all));
  Json& accessor = gltf.json["accessors"][joints];
  accessor["sparse"] = {{"count", all.size()},
                        {"indices", {{"bufferView", at}, {"componentType", 5121}}},
                        {"values", {{"bufferView", was["bufferView"]}}}};
  accessor.erase("bufferView");
  const auto bent = [](const SkinnedRig& rig) { return skinned_corners(rig, pose_of(rig, 1)); };
  EXPECT_EQ(bent(read(gltf)), bent(whole));
  accessor["sparse"]["count"] = 1;  // all others have joint 0
  EXPECT_NE(bent(read(gltf)), bent(whole));
}

TEST_F(ReadGltfRig, TakesANodeThatIsListedBesideItsParent) {
  Gltf gltf = bending_bar();
  const SkinnedRig whole = read(gltf);
  Json& roots = gltf.json["scenes"][0]["nodes"];
  for (int i = 0; i < static_cast<int>(gltf.json["nodes"].size()); ++i) roots.push_back(i);
  EXPECT_EQ(read(gltf).mesh.points, whole.mesh.points);
  EXPECT_EQ(read(gltf).rig.skeleton.size(), whole.rig.skeleton.size());
}

TEST_F(ReadGltfRig, TellsOfVerticesWithoutWeights) {
  Gltf gltf = bending_bar();
  EXPECT_TRUE(read(gltf).rig.warnings.empty());
  const int weights = gltf.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"];
  const int view = gltf.json["accessors"][weights]["bufferView"];
  const std::size_t begin = gltf.json["bufferViews"][view]["byteOffset"];
  gltf.bytes.replace(begin, 16, std::string(16, '\0'));
  EXPECT_NE(read(gltf).rig.warnings.at(0).find(": 1 of "), std::string::npos);
}

TEST_F(ReadGltfRig, FindsClipsByName) {
  const auto clips = read(bending_bar()).rig.clips;
  EXPECT_EQ(&find_clip(clips, "clip"), &clips[0]);
  expect_bad_input([&] { find_clip(clips, "clp"); }, {"no clip 'clp'", "did you mean clip?"});
  expect_bad_input([&] { find_clip({}, "run"); }, {"no clip 'run'", "with an animation"});
}

TEST_F(ReadGltfRig, NormalizesWeights) {
  Gltf gltf = bar();
  Json& attributes = gltf.json["meshes"][0]["primitives"][0]["attributes"];
  std::vector<float> weights;
  for (int i = 0; i < 15; ++i) weights.insert(weights.end(), {1, 3, 0, 0});
  weights[4] = weights[5] = 0;
  attributes["WEIGHTS_0"] = gltf.floats(weights, "VEC4");
  const SkinnedRig rig = read(gltf);
  ASSERT_EQ(rig.weights.of(0).size(), 2u);
  EXPECT_EQ(rig.weights.of(0)[0].bone, 1);
  EXPECT_EQ(rig.weights.of(0)[0].weight, 0.75);
  EXPECT_EQ(rig.weights.of(0)[1].weight, 0.25);
  EXPECT_TRUE(rig.weights.of(1).empty()) << "a vertex without weights";
}

TEST_F(ReadGltfRig, AddsWeightsOfOneBone) {
  Gltf gltf = bar();
  Json& attributes = gltf.json["meshes"][0]["primitives"][0]["attributes"];
  std::vector<std::uint16_t> joints, parts;
  for (int i = 0; i < 15; ++i) {
    joints.insert(joints.end(), {1, 0, 1, 0});
    parts.insert(parts.end(), {16384, 32767, 16384, 0});
  }
  attributes["JOINTS_0"] = gltf.accessor(gltf.view(raw(joints)), 15, "VEC4", 5123);
  attributes["WEIGHTS_0"] = gltf.accessor(gltf.view(raw(parts)), 15, "VEC4", 5123);
  gltf.json["accessors"][attributes["WEIGHTS_0"].get<int>()]["normalized"] = true;
  attributes["JOINTS_1"] = attributes["JOINTS_0"];
  attributes["WEIGHTS_1"] = attributes["WEIGHTS_0"];
  const SkinnedRig rig = read(gltf);
  ASSERT_EQ(rig.weights.of(3).size(), 2u);
  EXPECT_NEAR(rig.weights.of(3)[0].weight, 32768.0 / 65535, 1e-12);
  EXPECT_EQ(rig.weights.of(3)[0].bone, 1);
}

TEST_F(ReadGltfRig, UnitesSkins) {
  Gltf gltf = bending_bar();
  Json& nodes = gltf.json["nodes"];
  nodes[2]["children"] = {gltf.node({{"name", "tip"}, {"translation", {0, 0, 1}}})};
  // The same mesh in a space of its own, 10 m away, with joints in another order.
  const Affine away(Eigen::Translation3d(-10, 0, 0));
  const Affine end = Eigen::Translation3d(0, 0, -2) * away,
               upper = Eigen::Translation3d(0, 0, -1) * away;
  const int skin =
      gltf.add("skins", {{"joints", {2, 1}}, {"inverseBindMatrices", gltf.matrices({end, upper})}});
  gltf.json["scenes"][0]["nodes"].push_back(gltf.node({{"mesh", 0}, {"skin", skin}}));
  const SkinnedRig rig = read(gltf);
  ASSERT_EQ(rig.rig.skeleton.size(), 3u);
  EXPECT_EQ(rig.rig.skeleton.bones[2].parent, 1);
  EXPECT_LT((rig.rig.skeleton.bones[2].tail() - Vec3(0, 0, 3)).norm(), single);
  const std::size_t half = rig.mesh.points.size() / 2;
  EXPECT_LT((rig.mesh.points[half] - rig.mesh.points[0] + Vec3(10, 0, 0)).norm(), single);
  EXPECT_EQ(rig.weights.of(half)[0].bone, 2) << "joint 0 of the second skin";
}

TEST(BoxBendGlb, MovesAsTheSceneOfTheSameName) {
  const std::filesystem::path source = test::source_dir();
  const Settings settings = read_scene(source / "configs/box_bend.yaml");
  const Skeleton skeleton = skeleton_of(settings);
  const Motion motion = motion_of(settings, skeleton);
  const SkinnedRig rig = read_gltf_rig(source / "data/motions/box_bend.glb");
  ASSERT_EQ(rig.rig.skeleton.size(), 2u);
  const Clip& clip = find_clip(rig.rig.clips, "bend");
  EXPECT_EQ(clip.frames, 151);
  for (const double time : clip.motion.tracks.at(0).rotation.times) {
    const Pose expected = pose_at(skeleton, motion, time);
    const Pose pose = pose_at(rig.rig.skeleton, clip.motion, time);
    for (std::size_t i = 0; i < 2; ++i) {
      const RigidFrame &frame = pose[i].frame, &same = expected[i].frame;
      EXPECT_EQ(rig.rig.skeleton.bones[i].name, skeleton.bones[i].name);
      EXPECT_NEAR(rig.rig.skeleton.bones[i].length, skeleton.bones[i].length, single);
      EXPECT_LT((frame.origin - same.origin).norm(), single) << time;
      EXPECT_LT((frame.rotation - same.rotation).norm(), single) << time;
    }
  }
}

TEST(BoxBendGlb, HoldsTheBoxAndItsWeights) {
  const std::filesystem::path file =
      std::filesystem::path(test::source_dir()) / "data/motions/box_bend.glb";
  const SkinnedRig rig = read_gltf_rig(file);
  EXPECT_EQ(rig.mesh.points.size(), 1062u);
  EXPECT_EQ(rig.mesh.polygons.size(), 2120u);
  EXPECT_EQ(read_gltf(file).points, rig.mesh.points);
  for (std::size_t i = 0; i < rig.mesh.points.size(); ++i) {
    double sum = 0;
    for (const BoneWeight& weight : rig.weights.of(i)) sum += weight.weight;
    EXPECT_NEAR(sum, 1, 1e-12);
    EXPECT_EQ(rig.weights.of(i)[0].bone, rig.mesh.points[i].z() > 0.3465 ? 1 : 0);
  }
}

}  // namespace sinew::gltf_rig_test
