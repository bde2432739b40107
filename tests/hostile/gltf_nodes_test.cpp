// SPDX-License-Identifier: GPL-3.0-or-later
// glTF files whose nodes, lists, extensions and buffers are wrong.
#include "gltf_hostile.h"

#include <cmath>
#include <random>

namespace sinew::gltf_nodes_test {

TEST_F(HostileGltf, OfWrongNodesIsRefused) {
  expect_refused_with("/nodes/0/children", {0}, "children of themselves");
  expect_refused_with("/nodes/0/scale", {1, 1}, "nodes[0].scale holds 2 numbers, not 3");
  expect_refused_with("/nodes/0/matrix", {1}, "nodes[0].matrix holds 1 numbers, not 16");
  expect_refused_with("/nodes/0/translation", {0, 0, 1e300}, "too large for a float");
  expect_refused_with("/nodes/0/translation", {0, 0, "1"}, "not a number");
  expect_refused_with("/nodes/0/rotation", {0, 0, 0, 0}, "nodes[0].rotation is of length 0");
  expect_refused_with("/nodes/0/matrix", std::vector<int>(16, 1), "does not end in the row");
  expect_refused_with("/scenes/0/nodes", {0, 9}, "its scene names node 9");
  expect_refused_with("/scenes/0/nodes", Json::array(), "its scene shows no triangles");
}

TEST_F(HostileGltf, OfNodesInCirclesIsRefused) {
  Gltf gltf = one_tetrahedron();
  gltf.node({{"children", {2}}});
  gltf.node({{"children", {3}}});
  gltf.node({{"children", {1}}});
  expect_refused(gltf, "some of its nodes are children of themselves");
  gltf.json["scenes"][0]["nodes"] = {1};
  expect_refused(gltf, "some of its nodes are children of themselves");
}

TEST_F(HostileGltf, OfANodeWithTwoParentsIsRefused) {
  Gltf gltf = one_tetrahedron();
  gltf.node({{"children", {0}}});
  gltf.node({{"children", {0}}});
  expect_refused(gltf, "node 0 has two parents");
  gltf.json["nodes"][2]["children"] = {1, 1};
  expect_refused(gltf, "node 1 has two parents");
}

TEST_F(HostileGltf, OfVeryDeepNodesIsRefused) {
  Gltf gltf = one_tetrahedron();
  for (int i = 0; i < 99000; ++i) gltf.node({{"children", {i}}});
  gltf.json["scenes"][0]["nodes"] = {99000};
  expect_refused(gltf, "its nodes are nested more than 1000 deep");
}

TEST_F(HostileGltf, ThatShowsMoreThanMemoryHoldsIsRefusedSoon) {
  Gltf gltf = one_tetrahedron();
  const std::size_t corners = 3 << 20;
  const int indices = gltf.accessor(gltf.view(std::string(corners, '\0')), corners, "SCALAR", 5121);
  gltf.json["meshes"][0]["primitives"][0]["indices"] = indices;
  std::vector<int> nodes(99000);
  for (int& node : nodes) node = gltf.node({{"mesh", 0}});
  gltf.json["scenes"][0]["nodes"] = nodes;
  const auto path = write(folder, gltf, Form::packed);
  EXPECT_TRUE(
      contains(answer(path), "its scene shows 103809024000 triangles, too many for memory"));
}

TEST_F(HostileGltf, OfEndlessListsIsRefused) {
  Gltf gltf = one_tetrahedron();
  for (int i = 0; i < 100000; ++i) gltf.node({{"mesh", 0}});
  expect_refused(gltf, "nodes lists 100001 items");
}

TEST_F(HostileGltf, ThatNeedsAnExtensionNamesIt) {
  const std::pair<const char*, const char*> extensions[] = {
      {"KHR_meshopt_compression", "export without mesh compression"},
      {"EXT_mesh_gpu_instancing", "export without instancing"},
      {"X_my\nown", "export without it"}};
  for (const auto& [name, cure] : extensions)
    expect_refused_with("/extensionsRequired", {name}, cure);
  expect_refused_with("/extensionsRequired", {"KHR_meshopt_compression"},
                      "'KHR_meshopt_compression'");
  expect_refused_with("/nodes/0/extensions/EXT_mesh_gpu_instancing", Json::object(),
                      "export without instancing");
}

TEST_F(HostileGltf, WhoseDataIsCompressedAwayIsRefused) {
  for (const int accessor : {0, 1}) {
    Gltf gltf = one_tetrahedron();
    gltf.json["accessors"][accessor].erase("bufferView");
    expect_refused(gltf, "have no data; export without mesh compression");
  }
  Gltf gltf = one_tetrahedron();
  gltf.json["buffers"] = {{{"byteLength", 48}}};
  EXPECT_TRUE(contains(answer(write(folder, gltf, Form::beside)), "a buffer has no data"));
}

TEST_F(HostileGltf, OfBadSparseDataIsRefused) {
  Gltf gltf = one_tetrahedron();
  const int at = gltf.view(raw(std::vector<std::uint32_t>{4}));
  const int value = gltf.view(raw(Points{{0, 0, 5}}));
  gltf.json["accessors"][0]["sparse"] = {{"count", 1},
                                         {"indices", {{"bufferView", at}, {"componentType", 5125}}},
                                         {"values", {{"bufferView", value}}}};
  const auto with = [&](const char* pointer, const Json& json) {
    Gltf changed = gltf;
    changed.json["accessors"][0]["sparse"][Json::json_pointer(pointer)] = json;
    return changed;
  };
  expect_refused(gltf, "accessors[0].sparse names element 4 of 4");
  gltf.bytes.replace(96, 4, word(0xffffffff));
  expect_refused(gltf, "accessors[0].sparse names element 4294967295 of 4");
  expect_refused(with("/count", 5), "accessors[0].sparse does not fit it");
  expect_refused(with("/count", 2), "accessors[0].sparse.indices ends at byte 8");
  expect_refused(with("/indices/componentType", 5126), "accessors[0].sparse does not fit it");
  expect_refused(with("/indices/bufferView", 9), "names bufferView 9 of 4");
  expect_refused(with("/indices/byteOffset", 4), "accessors[0].sparse.indices ends at byte 8");
  expect_refused(with("/values/bufferView", 9), "names bufferView 9 of 4");
  expect_refused(with("/values/byteOffset", 4), "accessors[0].sparse.values ends at byte 16");
  expect_refused(with("/values", nullptr), "values is 'null', not an object");
  gltf.bytes.replace(96, 4, word(0));
  gltf.json["accessors"][0].erase("bufferView");
  gltf.json["accessors"][0]["count"] = 2000000000;
  expect_refused(gltf, "accessors[0] has 2000000000 elements, more than its file has");
}

TEST_F(HostileGltf, WhoseBufferIsElsewhereIsRefused) {
  std::filesystem::create_directory(folder / "in");
  std::filesystem::create_directory(folder / "in" / "side.bin");
  put(folder / "out.bin", one_tetrahedron().bytes);
  const auto said = [&](const std::string& uri) {
    Gltf gltf = one_tetrahedron();
    gltf.json["buffers"] = {{{"byteLength", gltf.bytes.size()}, {"uri", uri}}};
    return answer(write(folder / "in", gltf, Form::embedded));
  };
  const std::string outside = "outside the file's own folder; put the .bin file beside it";
  for (const std::string& uri :
       {std::string("../out.bin"), std::string("%2e%2e/out.bin"), std::string("..%2Fout.bin"),
        std::string("a/../../out.bin"), (folder / "out.bin").string(),
        "file://" + (folder / "out.bin").string(), std::string("http://localhost/a.bin"),
        std::string(""), std::string(".."), std::string("a%00.bin")})
    EXPECT_TRUE(contains(said(uri), outside)) << uri << ": " << said(uri);
  EXPECT_TRUE(contains(said("none.bin"), "in/none.bin: cannot be read: No such file"));
  EXPECT_TRUE(contains(said("side.bin"), "in/side.bin: is not a regular file"));
  EXPECT_TRUE(contains(said("."), "is not a regular file")) << said(".");
  EXPECT_TRUE(contains(said("mesh.gltf%"), "in/mesh.gltf%: cannot be read"));
}

TEST_F(HostileGltf, OfBadDataUrisIsRefused) {
  const auto said = [&](const std::string& uri) {
    Gltf gltf = one_tetrahedron();
    gltf.json["buffers"] = {{{"byteLength", gltf.bytes.size()}, {"uri", uri}}};
    return answer(write(folder, gltf, Form::embedded));
  };
  const std::string good = base64(one_tetrahedron().bytes);
  EXPECT_EQ(said("data:;base64," + good), "");
  for (const char* start : {"data:", "data:,", "data:base64", "data:text/plain,", "data:;base64"})
    EXPECT_TRUE(contains(said(start + good), "is not in base64")) << start;
  EXPECT_TRUE(contains(said("data:;base64,"), "but 0 are there"));
  EXPECT_TRUE(contains(said("data:;base64,A"), "but 0 are there"));
  EXPECT_TRUE(contains(said("data:;base64," + good.substr(4)), "says it has 96 bytes, but 93"));
  for (const char* wrong : {"!", "====", "\n"})
    EXPECT_TRUE(contains(said("data:;base64," + (wrong + good)), "is not in base64")) << wrong;
}

}  // namespace sinew::gltf_nodes_test
