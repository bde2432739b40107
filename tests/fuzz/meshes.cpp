// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/polygon_soup.h"
#include "io/gltf/read_gltf.h"
#include "io/gltf/read_rig.h"
#include "mesh/mesh_readers.h"
#include "targets.h"

namespace sinew::fuzz {
namespace {

void require_sound(const PolygonSoup& soup) {
  for (const Vec3& point : soup.points) require(point.allFinite());
  for (const auto& polygon : soup.polygons) {
    require(polygon.size() >= 3);
    for (const int corner : polygon)
      require(corner >= 0 && corner < static_cast<int>(soup.points.size()));
  }
}

void mesh(std::string_view bytes, MeshFormat format) {
  expect_sound_or_refused([&] {
    require_sound(read_mesh({"fuzz.mesh", format, std::string(bytes)}));
  });
}

}  // namespace

void obj(std::string_view bytes) { mesh(bytes, MeshFormat::obj); }
void off(std::string_view bytes) { mesh(bytes, MeshFormat::off); }
void ply(std::string_view bytes) { mesh(bytes, MeshFormat::ply); }
void stl(std::string_view bytes) { mesh(bytes, MeshFormat::stl); }

void gltf(std::string_view bytes) {
  const bool binary = bytes.substr(0, 4) == "glTF";
  const auto path = file_of(bytes, binary ? "fuzz.glb" : "fuzz.gltf");
  expect_sound_or_refused([&] { require_sound(read_gltf(path)); });
  expect_sound_or_refused([&] {
    const GltfRig rig = read_gltf_rig(path);
    require_sound(rig.mesh);
    for (const Bone& bone : rig.rig.skeleton.bones)
      require(bone.length > 0 && bone.rest.origin.allFinite() && bone.rest.rotation.allFinite() &&
              is_one_line(bone.name));
    for (const Clip& clip : rig.rig.clips) require(is_one_line(clip.name));
  });
}

}  // namespace sinew::fuzz
