// SPDX-License-Identifier: GPL-3.0-or-later
// glTF files that are cut short, lie, or are something else: each gives exit code 2 and one line
// that names the file and a cure, and none a crash or a word on the console.
#include "gltf_hostile.h"

#include <cmath>
#include <random>

namespace sinew::gltf_test {

TEST_F(HostileGltf, IsTakenWhenNothingIsWrong) {
  for (const Form form : forms) EXPECT_EQ(answer(write(folder, one_tetrahedron(), form)), "");
}

TEST_F(HostileGltf, CutAtAnyTenthIsRefused) {
  for (const Form form : forms) {
    const auto path = write(folder, one_tetrahedron(), form);
    const std::string whole = text_of(path), data = one_tetrahedron().bytes;
    for (std::size_t tenth = 0; tenth < 10; ++tenth)
      expect_refused(path.filename(), whole.substr(0, whole.size() * tenth / 10));
    put(path, whole);
    for (std::size_t tenth = 0; form == Form::beside && tenth < 10; ++tenth) {
      put(folder / "mesh.bin", data.substr(0, data.size() * tenth / 10));
      EXPECT_TRUE(contains(answer(path), "are there; export it again"));
    }
  }
}

TEST_F(HostileGltf, CutAnywhereIsRefused) {
  const std::string whole = text_of(write(folder, one_tetrahedron(), Form::packed));
  for (std::size_t size = 0; size < whole.size(); size += 3)
    expect_refused("mesh.glb", whole.substr(0, size));
}

TEST_F(HostileGltf, WithAnyByteBrokenIsTakenOrRefusedButNeverCrashes) {
  constexpr char bytes[] = {'\0', '\xff', '9', '-', '\n', '{', '"'};
  for (const Form form : {Form::embedded, Form::packed}) {
    const auto path = write(folder, one_tetrahedron(), form);
    const std::string whole = text_of(path);
    for (std::size_t i = 0; i < whole.size(); ++i) {
      std::string broken = whole;
      broken[i] = bytes[i % sizeof bytes];
      put(path, broken);
      answer(path);
    }
  }
}

TEST_F(HostileGltf, OfGarbageIsRefused) {
  std::string garbage;
  std::mt19937 random(7);
  for (int i = 0; i < 20000; ++i) garbage += static_cast<char>(random());
  for (const char* name : {"a.gltf", "a.glb"}) {
    expect_refused(name, "", "it is empty");
    expect_refused(name, garbage);
    expect_refused(name, " \n\n \t\n");
    expect_refused(name, std::string(5000, '\0'));
    expect_refused(name, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    expect_refused(name, "glTF" + garbage);
  }
}

TEST_F(HostileGltf, UnderAnotherExtensionIsRefused) {
  const std::string packed = text_of(write(folder, one_tetrahedron(), Form::packed));
  const std::string plain = text_of(write(folder, one_tetrahedron(), Form::embedded));
  expect_refused("a.gltf", packed, "rename it to .glb");
  expect_refused("a.glb", plain, "rename it to .gltf");
  expect_refused("a.obj", packed, "give a .gltf, .glb or .vrm file");
  expect_refused("mesh", plain, "give a .gltf, .glb or .vrm file");
}

TEST_F(HostileGltf, ThatIsLargeIsRefusedBeforeItIsRead) {
  const std::string header = text_of(write(folder, one_tetrahedron(), Form::packed)).substr(0, 12);
  const double memory = raised_memory([&] {
    for (const char* name : {"a.glb", "a.gltf"})
      for (const std::string& begin : {std::string(), std::string("v 0 0 0\n")}) {
        put_sparse(folder / name, begin, 3'000'000'000);
        EXPECT_NE(answer(folder / name), "");
      }
    put_sparse(folder / "a.glb", header, 3'000'000'000);
    EXPECT_TRUE(contains(answer(folder / "a.glb"), "but has 3000000000"));
    put_sparse(folder / "a.gltf", "{", 3'000'000'000);
    EXPECT_TRUE(contains(answer(folder / "a.gltf"), "is larger than"));
  });
  EXPECT_LT(memory, 50e6);
}

TEST_F(HostileGltf, ReadsOfABufferOnlyWhatItUses) {
  const auto path = write(folder, one_tetrahedron(), Form::beside);
  std::filesystem::resize_file(folder / "mesh.bin", 3'000'000'000);
  EXPECT_LT(raised_memory([&] { EXPECT_EQ(answer(path), ""); }), 50e6);
}

TEST_F(HostileGltf, ThatIsNoFileIsRefused) {
  std::filesystem::create_directory(folder / "folder.glb");
  EXPECT_TRUE(contains(answer(folder / "folder.glb"), "is not a regular file"));
  EXPECT_TRUE(contains(answer(folder / "missing.glb"), "No such file"));
}

TEST_F(HostileGltf, WithAHeaderThatLiesIsRefused) {
  const std::string whole = text_of(write(folder, one_tetrahedron(), Form::packed));
  const auto with = [&](std::size_t at, const std::string& bytes) {
    std::string broken = whole;
    return broken.replace(at, bytes.size(), bytes);
  };
  expect_refused("a.glb", with(4, word(1)), "export it as glTF 2.0");
  expect_refused("a.glb", with(8, word(0)), "it says it has 0 bytes");
  expect_refused("a.glb", with(8, word(0xffffffff)), "it says it has 4294967295 bytes");
  expect_refused("a.glb", with(12, word(0xffffffff)), "a chunk says it has 4294967295 bytes");
  expect_refused("a.glb", with(12, word(0x80000000)), "a chunk says it has 2147483648 bytes");
  expect_refused("a.glb", with(12, word(0)));
  expect_refused("a.glb", with(16, "BIN "), "its first chunk alone must be JSON");
  expect_refused("a.glb", whole + "1234", "it says it has");
  expect_refused("a.glb", "glTF" + word(2) + word(12), "it holds no chunks");
  expect_refused("a.glb", glb(one_tetrahedron().json.dump(), ""), "of 0");
}

TEST_F(HostileGltf, OfBrokenJsonIsRefused) {
  expect_refused("a.gltf", "{\"asset\": ", "its JSON is damaged at byte 11");
  expect_refused("a.gltf", "{\"asset\": 1e999}", "a number that is too large");
  expect_refused("a.gltf", "{\"asset\": NaN}", "its JSON is damaged");
  expect_refused("a.gltf", "{} {}", "its JSON is damaged");
  expect_refused("a.gltf", "{\"\xff\": 1}", "its JSON is damaged");
  expect_refused("a.gltf", "[]", "its JSON is an array, not an object");
  expect_refused("a.gltf", "{}", "asset.version is missing");
  expect_refused("a.gltf", "\"text", "damaged");
  expect_refused("a.gltf", "\"text\\", "damaged");
}

TEST_F(HostileGltf, OfDeepJsonIsRefused) {
  for (const int depth : {101, 10000, 1000000}) {
    const std::string deep(depth, '[');
    expect_refused("a.gltf", "{\"extras\": " + deep, "nested more than 100 deep");
    expect_refused("a.gltf", "{\"extras\": " + deep + std::string(depth, ']') + "}",
                   "nested more than 100 deep");
  }
  std::string objects;
  for (int i = 0; i < 10000; ++i) objects += "{\"a\":";
  expect_refused("a.gltf", objects, "nested more than 100 deep");
}

TEST_F(HostileGltf, OfEndlessJsonIsRefused) {
  std::string many = "{\"extras\":[0";
  for (int i = 0; i < 4100000; ++i) many += ",0";
  expect_refused("a.gltf", many + "]}", "more than 4 million values");
  std::string nodes = "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{}";
  for (int i = 0; i < 100'000; ++i) nodes += ",{}";
  expect_refused("a.gltf", nodes + "]}", "nodes lists 100001 items, more than 100000");
}

TEST_F(HostileGltf, OfAnotherVersionIsRefused) {
  expect_refused_with("/asset/version", "1.0", "of glTF version '1.0'; export it as glTF 2.0");
  expect_refused_with("/asset/minVersion", "2.1", "of glTF version '2.1'");
  expect_refused_with("/asset/version", 2.0, "asset.version is '2.0', not text");
}

TEST_F(HostileGltf, WithWrongCountsIsRefused) {
  const Json wrong[] = {
      0,   -1,  -9007199254740992, 2147483648LL,  9007199254740992,        1e300,
      0.5, "4", nullptr,           Json::array(), 18446744073709551615ULL, Json::object()};
  for (const Json& value : wrong)
    for (const char* field : {"count", "componentType"}) {
      Gltf gltf = one_tetrahedron();
      gltf.json["accessors"][0][field] = value;
      expect_refused(gltf, std::string("accessors[0].") + field + " is ");
    }
  for (const Json& value : wrong)
    expect_refused_with("/bufferViews/0/byteLength", value, "bufferViews[0].byteLength is ");
  for (const Json& value : wrong) {
    Gltf gltf = one_tetrahedron();
    gltf.json["buffers"] = {{{"byteLength", value}}};
    expect_refused(gltf, "buffers[0].byteLength is ");
  }
}

TEST_F(HostileGltf, WithDataBeyondItsEndIsRefused) {
  const int most = 2147483000;
  for (const int value : {5, 1000, most}) {
    expect_refused_with("/accessors/0/count", value, "of a bufferView of 48; export it again");
    expect_refused_with("/accessors/1/count", 3 * (value / 3) + 12, "of a bufferView of 48");
    expect_refused_with("/accessors/0/byteOffset", value, "of a bufferView of 48");
    expect_refused_with("/bufferViews/0/byteOffset", value + 44, "ends at byte");
    expect_refused_with("/bufferViews/0/byteLength", value + 92, "ends at byte");
  }
  expect_refused_with("/bufferViews/0/byteStride", 252, "of a bufferView of 48");
  expect_refused_with("/bufferViews/0/byteStride", 8, "has elements of 12 bytes every 8");
  expect_refused_with("/bufferViews/0/byteStride", 0, "bufferViews[0].byteStride is '0'");
  expect_refused_with("/bufferViews/0/byteStride", 2147483647, "byteStride");
  expect_refused_with("/accessors/0/byteOffset", -4, "accessors[0].byteOffset is '-4'");
  expect_refused_with("/bufferViews/0/byteOffset", -4, "bufferViews[0].byteOffset is '-4'");
  Gltf gltf = one_tetrahedron();
  gltf.json["buffers"] = {{{"byteLength", 2147483647}}, {{"byteLength", 2147483647}}};
  expect_refused(gltf, "more than 2147483647 bytes");
}

TEST_F(HostileGltf, WithIndicesOfNothingIsRefused) {
  const std::pair<const char*, const char*> indices[] = {
      {"/scene", "scene"},
      {"/scenes/0/nodes/0", "node"},
      {"/nodes/0/mesh", "mesh"},
      {"/nodes/0/skin", "skin"},
      {"/nodes/0/children", "child"},
      {"/meshes/0/primitives/0/indices", "accessor"},
      {"/meshes/0/primitives/0/attributes/POSITION", "accessor"},
      {"/meshes/0/primitives/0/attributes/NORMAL", "accessor"},
      {"/accessors/0/bufferView", "bufferView"},
      {"/bufferViews/0/buffer", "buffer"}};
  for (const auto& [pointer, what] : indices)
    for (const Json& value : {Json(2), Json(2147483647), Json(2147483648LL), Json(-1), Json("0")}) {
      const bool list = std::string(what) == "child", whole = value == 2 || value == 2147483647;
      expect_refused_with(pointer, list ? Json{value} : value,
                          whole ? std::string(" names ") + what : " is ");
    }
}

TEST_F(HostileGltf, OfTheWrongKindIsRefused) {
  for (const Json& wrong : {Json(1), Json("text"), Json(true), Json(nullptr)})
    for (const char* field : {"scenes", "nodes", "meshes", "accessors", "bufferViews", "buffers"})
      expect_refused_with(std::string("/") + field, wrong, std::string(field) + " is ");
  for (const Json& wrong : {Json(1), Json("text"), Json(nullptr), Json::array()})
    for (const char* field : {"/nodes/0", "/meshes/0", "/accessors/0", "/bufferViews/0", "/asset"})
      expect_refused_with(field, wrong, "not an object");
  expect_refused_with("/accessors/0/type", "VEC9", "accessors[0].type is 'VEC9'");
  expect_refused_with("/accessors/0/type", "VEC4", "ends at byte 64");
  expect_refused_with("/accessors/0/type", "VEC2", "not VEC3 of 5126");
  expect_refused_with("/accessors/0/componentType", 5124, "componentType is 5124");
  expect_refused_with("/accessors/0/componentType", 5125, "export positions as floats");
  expect_refused_with("/accessors/1/componentType", 5126, "not plain unsigned numbers");
  expect_refused_with("/accessors/1/normalized", true, "not plain unsigned numbers");
  expect_refused_with("/meshes/0/primitives/0/mode", 7, "between 0 and 6");
  expect_refused_with("/meshes/0/primitives/0/indices", 0, "not plain unsigned numbers");
}

TEST_F(HostileGltf, WithCornersThatMakeNoTrianglesIsRefused) {
  expect_refused_with("/accessors/1/count", 11, "has 11 corners");
  for (const int mode : {4, 5, 6}) {
    Gltf gltf = one_tetrahedron();
    gltf.json["accessors"][1]["count"] = 2;
    gltf.json["meshes"][0]["primitives"][0]["mode"] = mode;
    expect_refused(gltf, "has 2 corners");
  }
  Gltf gltf = one_tetrahedron();
  gltf.json["meshes"][0]["primitives"][0].erase("indices");
  expect_refused(gltf, "has 4 corners");
}

TEST_F(HostileGltf, WithCornersThatAreNotThereIsRefused) {
  for (const std::uint32_t corner : {4u, 255u, 65535u, 2147483648u, 4294967295u}) {
    Gltf gltf = one_tetrahedron();
    gltf.bytes.replace(48 + 20, 4, word(corner));
    expect_refused(gltf, "mesh 0 '': a triangle names vertex " + std::to_string(corner) + " of 4");
  }
}

TEST_F(HostileGltf, WithCoordinatesThatAreNoNumbersIsRefused) {
  for (const float x : {NAN, INFINITY, -INFINITY}) {
    Gltf gltf = one_tetrahedron();
    gltf.json["meshes"][0]["name"] = "Body\n";
    gltf.bytes.replace(12, 4, raw(std::vector{x}));
    expect_refused(gltf, "mesh 0 'Body?': vertex 1 is not finite");
  }
}

}  // namespace sinew::gltf_test
