// SPDX-License-Identifier: GPL-3.0-or-later
// Rigs in glTF files that are cut short or lie: each gives exit code 2 and one line that names the
// file and a cure, and none a crash or a word on the console.
#include <cctype>
#include <cmath>
#include <functional>

#include <sinew/io/gltf/rig.h>
#include "io/gltf_rigs.h"

namespace sinew::gltf_rig_test {

using namespace gltf_files;

void expect_error_line(const Error& error, const std::string& path) {
  const std::string message = error.what();
  EXPECT_EQ(error.exit(), Exit::bad_input) << message;
  EXPECT_EQ(message.rfind(path + ": ", 0), 0u) << message;
  EXPECT_NE(message.find("; "), std::string::npos) << message;
  for (const char c : message) EXPECT_FALSE(std::iscntrl(static_cast<unsigned char>(c))) << message;
  EXPECT_LT(message.size(), 2 * path.size() + 300) << message;
}

/// A rig that was taken holds together: bones, poses at some times, weights.
void expect_sound(const SkinnedRig& rig) {
  const Skeleton& skeleton = rig.rig.skeleton;
  EXPECT_GT(skeleton.size(), 0u);
  for (const Bone& bone : skeleton.bones) EXPECT_GT(bone.length, 0);
  for (const Clip& clip : rig.rig.clips)
    for (const double part : {-1.0, 0.0, 0.3, 1.0, 2.0})
      for (const BonePose& pose : pose_at(skeleton, clip.motion, part * clip.duration))
        EXPECT_TRUE(pose.frame.origin.allFinite() && pose.turn.allFinite());
  ASSERT_EQ(rig.weights.first.size(), rig.mesh.points.size() + 1);
  for (std::size_t i = 0; i < rig.mesh.points.size(); ++i)
    for (const BoneWeight& weight : rig.weights.of(i)) {
      EXPECT_LT(static_cast<std::size_t>(weight.bone), skeleton.size());
      EXPECT_TRUE(weight.weight > 0 && weight.weight <= 1);
    }
}

class HostileGltfRig : public Scratch {
 protected:
  /// What reading the file says; "" where it is taken.
  static std::string answer(const std::filesystem::path& path) {
    testing::internal::CaptureStderr();
    std::string message;
    try {
      expect_sound(read_gltf_rig(path));
    } catch (const Error& error) {
      message = error.what();
      expect_error_line(error, path.string());
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    return message;
  }

  void expect_refused(const Gltf& gltf, const std::string& part) const {
    const std::string message = answer(write(folder, gltf, Form::packed));
    EXPECT_FALSE(message.empty()) << "taken, instead of: " << part;
    EXPECT_TRUE(contains(message, part)) << "no \"" << part << "\" in: " << message;
  }

  /// The bending bar with one value put where the JSON pointer says.
  void expect_refused_with(const std::string& pointer, const Json& value, const std::string& part,
                           const std::string& interpolation = "LINEAR") const {
    Gltf gltf = bending_bar(interpolation);
    gltf.json[Json::json_pointer(pointer)] = value;
    expect_refused(gltf, part);
  }
};

// What bending_bar() has where.
const std::string primitive = "/meshes/0/primitives/0/attributes";
const std::string sampler = "/animations/0/samplers/0", channel = "/animations/0/channels/0";
constexpr int positions = 0, joints = 2, weights = 3, binds = 4, times = 5, values = 6;

std::string accessor(int index, const char* key) {
  return "/accessors/" + std::to_string(index) + '/' + key;
}

/// The bar with a number written over one of an accessor's, `at` bytes from its start.
template <class Number>
Gltf with_number(int index, std::size_t at, Number number, Gltf gltf = bending_bar()) {
  const int view = gltf.json["accessors"][index]["bufferView"];
  const std::size_t start = gltf.json["bufferViews"][view]["byteOffset"];
  gltf.bytes.replace(start + at, sizeof number, raw(std::vector{number}));
  return gltf;
}

TEST_F(HostileGltfRig, IsTakenWhenNothingIsWrong) {
  for (const Form form : forms)
    for (const char* interpolation : {"STEP", "LINEAR", "CUBICSPLINE"})
      EXPECT_EQ(answer(write(folder, bending_bar(interpolation), form)), "");
}

TEST_F(HostileGltfRig, CutAnywhereIsRefused) {
  const std::string whole = text_of(write(folder, bending_bar(), Form::packed));
  for (std::size_t size = 0; size < whole.size(); size += 7) {
    put(folder / "mesh.glb", whole.substr(0, size));
    EXPECT_NE(answer(folder / "mesh.glb"), "") << size;
  }
}

TEST_F(HostileGltfRig, WithAThirdOfItsBytesBrokenInTurnIsTakenOrRefusedButNeverCrashes) {
  constexpr char bytes[] = {'\0', '\xff', '9', '-', '\n', '{', '"', '\x7f', '\x80'};
  const auto path = write(folder, bending_bar("CUBICSPLINE"), Form::packed);
  const std::string whole = text_of(path);
  for (std::size_t i = 0; i < whole.size(); i += 3) {
    std::string broken = whole;
    broken[i] = bytes[i % sizeof bytes];
    put(path, broken);
    answer(path);
  }
}

TEST_F(HostileGltfRig, WithIndicesOfNothingIsRefused) {
  const std::pair<std::string, const char*> indices[] = {
      {"/skins/0/joints/1", "node"},
      {"/skins/0/skeleton", "node"},
      {"/skins/0/inverseBindMatrices", "accessor"},
      {"/nodes/3/skin", "skin"},
      {primitive + "/JOINTS_0", "accessor"},
      {primitive + "/WEIGHTS_0", "accessor"},
      {sampler + "/input", "accessor"},
      {sampler + "/output", "accessor"},
      {channel + "/sampler", "sampler"},
      {channel + "/target/node", "node"}};
  for (const auto& [pointer, what] : indices)
    for (const Json& value : {Json(99), Json(2147483647), Json(2147483648LL), Json(-1), Json("0"),
                              Json(0.5), Json(nullptr), Json::array()}) {
      const bool whole = value == 99 || value == 2147483647;
      expect_refused_with(pointer, value, whole ? std::string(" names ") + what : " is ");
    }
}

TEST_F(HostileGltfRig, OfTheWrongKindIsRefused) {
  for (const Json& wrong : {Json(1), Json("text"), Json(true), Json(nullptr)}) {
    for (const char* list : {"skins", "animations"})
      expect_refused_with(std::string("/") + list, wrong, std::string(list) + " is ");
    expect_refused_with("/skins/0", wrong, "not an object");
    expect_refused_with("/animations/0", wrong, "not an object");
    expect_refused_with("/animations/0/samplers", wrong, "samplers is ");
    expect_refused_with("/animations/0/channels", wrong, "channels is ");
    expect_refused_with(sampler, wrong, "not an object");
    expect_refused_with(channel, wrong, "not an object");
    expect_refused_with(channel + "/target", wrong, "not an object");
    expect_refused_with("/skins/0/joints", wrong, "joints is ");
  }
  expect_refused_with(sampler + "/interpolation", "CUBIC", "interpolation is 'CUBIC'");
  expect_refused_with(sampler + "/interpolation", 1, "interpolation is '1', not text");
  expect_refused_with(channel + "/target/path", "turn", "path is 'turn'");
  expect_refused_with(channel + "/target", Json::object(), "target.path is missing");
  expect_refused_with("/animations/0/name", 7, "animations[0].name is '7', not text");
  expect_refused_with("/nodes/0/name", 7, "nodes[0].name is '7', not text");
}

TEST_F(HostileGltfRig, OfWrongSkinsIsRefused) {
  expect_refused_with("/skins", Json::array(), "skin");
  expect_refused_with("/skins/0/joints", Json::array(), "skins[0] has no joints");
  expect_refused_with("/skins/0/joints", {1, 1}, "skins[0] names node 1 twice");
  expect_refused_with("/skins/0/joints", {0, 1, 2}, "has 2 inverse bind matrices for 3 joints");
  expect_refused_with(accessor(binds, "count"), 1, "has 1 inverse bind matrices for 2 joints");
  expect_refused_with(accessor(binds, "count"), 3, "of a bufferView of 128");
  expect_refused_with(accessor(binds, "type"), "VEC4", "are not MAT4 of 5126");
  expect_refused_with(accessor(binds, "componentType"), 5125, "are not MAT4 of 5126");
  expect_refused_with("/skins/0/inverseBindMatrices", positions, "are not MAT4 of 5126");
}

/// An accessor without a view is of zeros, as its specification says.
TEST_F(HostileGltfRig, WithoutItsDataIsTheOneWithZeros) {
  for (const int index : {joints, weights, binds, times, values}) {
    Gltf none = bending_bar(), zeros = bending_bar();
    none.json["accessors"][index].erase("bufferView");
    const Json& one = zeros.json["accessors"][index];
    zeros.json["accessors"][index]["bufferView"] =
        zeros.view(std::string(one["count"].get<std::size_t>() * 64, '\0'));
    const std::string answer_of_zeros = answer(write(folder, zeros, Form::packed));
    EXPECT_EQ(answer(write(folder, none, Form::packed)), answer_of_zeros) << index;
    EXPECT_TRUE(index != joints || answer_of_zeros.empty()) << answer_of_zeros;
    none.json["accessors"][index]["count"] = 2'000'000'000;
    EXPECT_NE(answer(write(folder, none, Form::packed)), "");
  }
  Gltf gltf = bending_bar();
  gltf.json["buffers"] = {{{"byteLength", gltf.bytes.size()}, {"uri", "none.bin"}}};
  expect_refused(gltf, "none.bin: cannot be read: No such file");
}

TEST_F(HostileGltfRig, WithBindMatricesThatAreNoneIsRefused) {
  for (const float x : {NAN, INFINITY, -INFINITY})
    for (const std::size_t at : {0, 60, 112})
      expect_refused(with_number(binds, at, x), "hold a number that is not finite");
  expect_refused(with_number(binds, 0, 0.0F), "has a bind matrix that cannot be inverted");
  expect_refused(with_number(binds, 60, 2.0F), "do not end in the row 0 0 0 1");
  expect_refused(with_number(binds, 12, 1.0F), "do not end in the row 0 0 0 1");
  Gltf gltf = bending_bar();
  gltf.json["nodes"][0]["scale"] = {0, 0, 0};
  expect_refused(gltf, "cannot be inverted");
  gltf.json["nodes"][0]["scale"] = {1, 1, 1e-7};
  expect_refused(gltf, "cannot be inverted");
}

TEST_F(HostileGltfRig, WhoseJointsLieInOnePointIsRefused) {
  Gltf gltf = bending_bar();
  gltf.json["skins"][0].erase("inverseBindMatrices");
  for (const int node : {1, 2}) gltf.json["nodes"][node].erase("translation");
  expect_refused(gltf, "all joints lie in one point; give their nodes different places");
}

TEST_F(HostileGltfRig, WithWrongWeightsIsRefused) {
  expect_refused(with_number<std::uint8_t>(joints, 1, 2), "names joint 2 of 2");
  expect_refused(with_number<std::uint8_t>(joints, 2, 255), "names joint 255 of 2");
  expect_refused(with_number(weights, 0, -0.5F), "mesh 0 '' has the weight -0.5");
  for (const float x : {NAN, INFINITY})
    expect_refused(with_number(weights, 16, x), "weights hold a number that is not finite");
  expect_refused_with(accessor(joints, "count"), 14, "joints are 14 for 15 vertices");
  expect_refused_with(accessor(weights, "count"), 14, "weights are 14 for 15 vertices");
  expect_refused_with(accessor(joints, "count"), 1000, "of a bufferView of 60");
  expect_refused_with(accessor(joints, "componentType"), 5120,
                      "joints are VEC4 of component type 5120");
  expect_refused_with(accessor(joints, "type"), "VEC3", "joints are VEC3 of component type 5121");
  expect_refused_with(accessor(joints, "normalized"), true, "joints are VEC4");
  expect_refused_with(accessor(weights, "type"), "VEC2", "weights are VEC2 of component type 5126");
  expect_refused_with(accessor(weights, "componentType"), 5123,
                      "weights are VEC4 of component type 5123");
  expect_refused_with(primitive, {{"POSITION", 0}}, "mesh 0 '' has a skin but no weights");
  expect_refused_with(primitive, {{"POSITION", 0}, {"JOINTS_0", 2}}, "without the other");
  expect_refused_with(primitive, {{"POSITION", 0}, {"WEIGHTS_0", 3}}, "without the other");
  expect_refused_with(primitive, {{"POSITION", 0}, {"JOINTS_1", 2}, {"WEIGHTS_1", 3}},
                      "no weights");
}

TEST_F(HostileGltfRig, WithWrongTimesIsRefused) {
  for (const float x : {NAN, INFINITY, -INFINITY})
    for (const std::size_t at : {0, 4})
      expect_refused(with_number(times, at, x), "times hold a number that is not finite");
  expect_refused(with_number(times, 0, -1.0F), "begins at the time -1");
  expect_refused(with_number(times, 0, 2.0F), "times do not ascend: 1.000000 after 2.000000");
  expect_refused_with(accessor(times, "count"), 1, "has 2 values for 1 times");
  expect_refused_with(accessor(times, "count"), 3, "of a bufferView of 8");
  expect_refused_with(accessor(times, "type"), "VEC2", "accessors[5] ends at byte 16");
  expect_refused_with(sampler + "/input", positions, "times are not SCALAR of 5126");
  expect_refused_with(accessor(times, "componentType"), 5125, "times are not SCALAR of 5126");
}

TEST_F(HostileGltfRig, WithWrongValuesIsRefused) {
  for (const float x : {NAN, INFINITY, -INFINITY})
    expect_refused(with_number(values, 8, x), "values hold a number that is not finite");
  expect_refused(with_number(values, 12, 0.0F), "has a rotation of length 0");
  expect_refused_with(accessor(values, "count"), 1, "has 1 values for 2 times");
  expect_refused_with(sampler + "/interpolation", "CUBICSPLINE", "has 2 values for 2 times");
  expect_refused_with(sampler + "/interpolation", "LINEAR", "has 6 values for 2 times",
                      "CUBICSPLINE");
  expect_refused_with(accessor(values, "type"), "VEC3", "values are VEC3 of component type 5126");
  expect_refused_with(accessor(values, "componentType"), 5125,
                      "values are VEC4 of component type 5125");
  expect_refused_with(accessor(values, "componentType"), 5122,
                      "values are VEC4 of component type 5122");
  expect_refused_with(channel + "/target/path", "translation", "values are VEC4");
  expect_refused_with(channel + "/target/path", "scale", "values are VEC4");
}

TEST_F(HostileGltfRig, OfWrongChannelsIsRefused) {
  Gltf gltf = bending_bar();
  Json& animation = gltf.json["animations"][0];
  animation["channels"].push_back(animation["channels"][0]);
  expect_refused(gltf, "animations[0] moves node 1 twice");
  gltf = bending_bar();
  gltf.json["nodes"][1].erase("translation");
  gltf.json["nodes"][1]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 1};
  expect_refused(gltf, "moves node 1, which has a matrix");
}

TEST_F(HostileGltfRig, OfJointsInCirclesIsRefused) {
  expect_refused_with("/nodes/2/children", {0}, "children of themselves");
  expect_refused_with("/nodes/2/children", {1}, "node 1 has two parents");
  Gltf gltf = bending_bar();
  gltf.json["nodes"][0].erase("children");
  gltf.json["nodes"][2]["children"] = {1};
  expect_refused(gltf, "children of themselves");
}

TEST_F(HostileGltfRig, OfVeryDeepJointsIsRefused) {
  Gltf gltf = bending_bar();
  int last = 2;
  for (int i = 0; i < 1100; ++i) {
    const int next = gltf.node({{"translation", {0, 0, 1}}});
    gltf.json["nodes"][last]["children"] = {next};
    last = next;
  }
  expect_refused(gltf, "nested more than 1000 deep");
}

TEST_F(HostileGltfRig, OfNumbersThatGrowBeyondAllIsRefused) {
  Gltf gltf = bending_bar();
  gltf.json["nodes"][1]["translation"] = {1e38, 0, 1};
  int above = 0;
  for (int i = 0; i < 20; ++i)
    above = gltf.node({{"scale", {1e30, 1e30, 1e30}}, {"children", {above}}});
  gltf.json["scenes"][0]["nodes"] = {above, 3};
  expect_refused(gltf, "joint 'lower' (node 0) has a bind matrix that cannot be inverted");
}

TEST_F(HostileGltfRig, ThatTakesTooLongToSampleIsRefusedSoon) {
  Gltf gltf = bending_bar();
  add_keys<Vec3>(gltf, 0, "scale", "LINEAR", {0, 3e38F}, {{1, 1, 1}, {2, 2, 2}});
  expect_refused(gltf, "animation 0 'clip': it changes the size of joints");
  expect_refused(gltf, "too long to sample; export it without scale, or in parts");
}

TEST_F(HostileGltfRig, OfTooManyAnimationsIsRefusedSoon) {
  Gltf gltf = bar();
  const Json animation = {{"name", "a"}};
  gltf.json["animations"] = std::vector<Json>(20000, animation);
  expect_refused(gltf, "its 20000 animations of 4 nodes hold 0 keys, too many");
}

TEST_F(HostileGltfRig, ThatRepeatsItsKeysBeyondMemoryIsRefusedSoon) {
  Gltf gltf = bar();
  const std::size_t count = 1 << 20;
  const int input = gltf.floats(std::vector<float>(count), "SCALAR");
  const int output = gltf.floats(std::vector<float>(3 * count), "VEC3");
  const Json one = {{"input", input}, {"output", output}};
  Json animation = {{"samplers", {one}}};
  for (int i = 0; i < 9000; ++i) {
    const int node = gltf.node(Json::object());
    animation["channels"].push_back(
        {{"sampler", 0}, {"target", {{"node", node}, {"path", "scale"}}}});
  }
  gltf.json["animations"] = {animation};
  expect_refused(gltf, "hold 9437184000 keys, too many; export fewer of them");
}

}  // namespace sinew::gltf_rig_test
