// SPDX-License-Identifier: GPL-3.0-or-later
// Compressed glTF, packed here by the libraries that unpack it; without these the tests are
// skipped.
#include <sinew/io/gltf/geometry.h>
#include <sinew/io/gltf/rig.h>
#include <sinew/rig/motion.h>

#include "io/gltf_rigs.h"
#include "support/expect_error.h"

#if __has_include(<meshoptimizer.h>)
#include <meshoptimizer.h>
#define TEST_MESHOPT
#endif
#if __has_include(<draco/compression/encode.h>)
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#define TEST_DRACO
#endif

namespace sinew::gltf_compressed_test {

using namespace gltf_files;
using test::expect_bad_input;

class CompressedGltf : public Scratch {
 protected:
  std::string answer(const Gltf& gltf) const {
    try {
      read_gltf(write(folder, gltf, Form::packed));
    } catch (const Error& error) {
      EXPECT_EQ(error.exit(), Exit::bad_input);
      return error.what();
    }
    return "";
  }
};

#ifdef TEST_MESHOPT

constexpr const char* meshopt = "EXT_meshopt_compression";

/// Packs the view of an accessor of so many elements and bytes each.
void pack(Gltf& gltf, int accessor, std::size_t stride, const std::string& mode, std::string& out) {
  Json& view = gltf.json["bufferViews"][gltf.json["accessors"][accessor]["bufferView"].get<int>()];
  const std::size_t at = view["byteOffset"], count = gltf.json["accessors"][accessor]["count"];
  std::string packed(4 * count * stride + 1000, '\0');
  auto* to = reinterpret_cast<unsigned char*>(packed.data());
  const char* from = gltf.bytes.data() + at;
  if (mode == "ATTRIBUTES") {
    packed.resize(meshopt_encodeVertexBuffer(to, packed.size(), from, count, stride));
  } else {
    const auto* corners = reinterpret_cast<const std::uint32_t*>(from);
    packed.resize(meshopt_encodeIndexBuffer(to, packed.size(), corners, count));
  }
  view["buffer"] = 1;
  view["extensions"][meshopt] = {
      {"buffer", 0},          {"byteOffset", out.size()}, {"byteLength", packed.size()},
      {"byteStride", stride}, {"count", count},           {"mode", mode}};
  out += packed;
  out.resize((out.size() + 3) / 4 * 4);
}

/// The bending bar with all that moves it packed, in a file without the plain bytes.
Gltf packed_bar() {
  Gltf gltf = bending_bar();
  const std::size_t plain = gltf.bytes.size();
  std::string out;
  const std::pair<std::size_t, const char*> kinds[] = {
      {12, "ATTRIBUTES"}, {4, "TRIANGLES"},  {4, "ATTRIBUTES"}, {16, "ATTRIBUTES"},
      {64, "ATTRIBUTES"}, {4, "ATTRIBUTES"}, {16, "ATTRIBUTES"}};
  for (int i = 0; i < 7; ++i) pack(gltf, i, kinds[i].first, kinds[i].second, out);
  gltf.bytes = out;
  gltf.json["extensionsRequired"] = {meshopt};
  gltf.json["buffers"] = {
      {{"byteLength", out.size()}},
      {{"byteLength", plain}, {"extensions", {{meshopt, {{"fallback", true}}}}}}};
  return gltf;
}

TEST_F(CompressedGltf, OfMeshoptIsThePlainOne) {
  const SkinnedRig plain = read_gltf_rig(write(folder, bending_bar(), Form::packed));
  const SkinnedRig rig = read_gltf_rig(write(folder, packed_bar(), Form::packed));
  ASSERT_EQ(rig.mesh.polygons.size(), plain.mesh.polygons.size());
  for (std::size_t i = 0; i < rig.mesh.polygons.size(); ++i)  // it may begin with another corner
    for (const int corner : plain.mesh.polygons[i]) {
      const Vec3& point = plain.mesh.points[static_cast<std::size_t>(corner)];
      bool there = false;
      for (const int other : rig.mesh.polygons[i])
        there = there || rig.mesh.points[static_cast<std::size_t>(other)] == point;
      EXPECT_TRUE(there) << i;
    }
  for (std::size_t b = 0; b < 2; ++b) {
    EXPECT_EQ(rig.rig.skeleton.bones[b].tail(), plain.rig.skeleton.bones[b].tail());
    EXPECT_EQ(pose_at(rig.rig.skeleton, rig.rig.clips.at(0).motion, 0.7)[b].turn,
              pose_at(plain.rig.skeleton, plain.rig.clips.at(0).motion, 0.7)[b].turn);
  }
}

TEST_F(CompressedGltf, OfMeshoptThatIsDamagedIsRefused) {
  const std::string entry = std::string("/extensions/") + meshopt;
  const auto refused = [&](const std::string& pointer, const Json& value, const char* part) {
    Gltf gltf = packed_bar();
    gltf.json[Json::json_pointer("/bufferViews/0" + pointer)] = value;
    const std::string message = answer(gltf);
    EXPECT_NE(message.find(part), std::string::npos) << pointer << ": " << message;
  };
  refused(entry + "/count", 2000000000, "and unpacks to");
  refused(entry + "/count", 16, "and unpacks to 192");
  refused(entry + "/byteStride", 10, "in no way of meshopt");
  refused(entry + "/mode", "OTHER", "in no way of meshopt");
  refused(entry + "/filter", "QUATERNION", "in no way of meshopt");
  refused(entry + "/byteLength", 5, "cannot be unpacked");
  refused(entry + "/byteLength", 1000000, "ends at byte");
  refused(entry + "/buffer", 7, "names buffer 7");
  Gltf large = packed_bar();
  Json& view = large.json["bufferViews"][0];
  view["extensions"][meshopt]["count"] = 100000000;
  view["byteLength"] = 1200000000;
  EXPECT_NE(answer(large).find("and unpacks to 1200000000"), std::string::npos) << answer(large);
  Gltf broken = packed_bar();
  for (std::size_t i = 0; i < broken.bytes.size(); ++i) {
    broken.bytes[i] = static_cast<char>(~broken.bytes[i]);
    answer(broken);
    broken.bytes[i] = static_cast<char>(~broken.bytes[i]);
  }
}

#endif
#ifdef TEST_DRACO

constexpr const char* draco_name = "KHR_draco_mesh_compression";

/// The tetrahedron in Draco's data alone.
Gltf draco_tetrahedron() {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(4);
  const int position =
      builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const PolygonSoup soup = tetrahedron();
  for (std::uint32_t f = 0; f < 4; ++f) {
    std::array<std::array<float, 3>, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k)
      for (int x = 0; x < 3; ++x)
        corners[k][static_cast<std::size_t>(x)] =
            static_cast<float>(soup.points[static_cast<std::size_t>(soup.polygons[f][k])][x]);
    builder.SetAttributeValuesForFace(position, draco::FaceIndex(f), corners[0].data(),
                                      corners[1].data(), corners[2].data());
  }
  const auto mesh = builder.Finalize();
  draco::EncoderBuffer buffer;
  draco::Encoder().EncodeMeshToBuffer(*mesh, &buffer);
  Gltf gltf = one_tetrahedron();
  gltf.bytes.clear();
  gltf.json["bufferViews"] = Json::array();
  for (Json& accessor : gltf.json["accessors"]) accessor.erase("bufferView");
  const int view = gltf.view(std::string(buffer.data(), buffer.size()));
  gltf.json["meshes"][0]["primitives"][0]["extensions"][draco_name] = {
      {"bufferView", view}, {"attributes", {{"POSITION", mesh->attribute(position)->unique_id()}}}};
  gltf.json["extensionsRequired"] = {draco_name};
  return gltf;
}

TEST_F(CompressedGltf, OfDracoIsThePlainOne) {
  Gltf gltf = draco_tetrahedron();
  for (const int points : {4, 3, 2000000000}) {  // as the exporter counted them
    gltf.json["accessors"][0]["count"] = points;
    EXPECT_EQ(answer(gltf), "");
  }
  const PolygonSoup soup = read_gltf(write(folder, gltf, Form::packed));
  ASSERT_EQ(soup.polygons.size(), 4u);
  double six = 0;
  for (const auto& face : soup.polygons) {
    std::vector<Vec3> c;
    for (const int corner : face) c.push_back(soup.points[static_cast<std::size_t>(corner)]);
    six += c[0].dot(c[1].cross(c[2]));
  }
  EXPECT_NEAR(six, 1, 1e-6) << "its volume, outward";
}

TEST_F(CompressedGltf, OfDracoThatIsDamagedIsRefused) {
  ASSERT_EQ(answer(draco_tetrahedron()), "");
  const auto refused = [&](const std::string& pointer, const Json& value, const char* part) {
    Gltf gltf = draco_tetrahedron();
    gltf.json[Json::json_pointer(pointer)] = value;
    const std::string message = answer(gltf);
    EXPECT_NE(message.find(part), std::string::npos) << pointer << ": " << message;
  };
  refused("/accessors/1/count", 15, "has 4 faces, its accessor 5");
  refused("/accessors/1/count", 2147483646, "its accessor 715827882");
  refused("/bufferViews/0/byteLength", 9, "is cut short");
  refused("/bufferViews/0/byteLength", 40, "is damaged");
  Gltf broken = draco_tetrahedron();
  for (std::size_t i = 0; i < broken.bytes.size(); ++i)
    for (const int flip : {0xff, 0x80, 1}) {
      broken.bytes[i] = static_cast<char>(broken.bytes[i] ^ flip);
      answer(broken);
      broken.bytes[i] = static_cast<char>(broken.bytes[i] ^ flip);
    }
}

#endif

}  // namespace sinew::gltf_compressed_test
