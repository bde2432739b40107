// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/detail/materials.h>
#include <sinew/io/gltf/geometry.h>
#include <sinew/io/gltf/look.h>
#include <sinew/io/gltf/rig.h>
#include "sound_mesh.h"

namespace sinew::fuzz {

void gltf(std::string_view bytes) {
  const bool binary = bytes.substr(0, 4) == "glTF";
  const auto path = file_of(bytes, binary ? "fuzz.glb" : "fuzz.gltf");
  expect_sound_or_refused([&] { require_sound(read_gltf(path)); });
  expect_sound_or_refused([&] {
    PolygonLook look;
    const PolygonSoup soup = read_gltf_look(path, look);
    require_sound(soup);
    require_sound(soup, look);
    for (const SurfaceLook::Layer& layer : look.look.layers)
      require(layer.values.size() == soup.points.size() * std::size_t(layer.components));
    require(look.look.gltf.json.empty() == names_of(look.look.gltf).empty());
  });
  expect_sound_or_refused([&] {
    const SkinnedRig rig = read_gltf_rig(path);
    require_sound(rig.mesh);
    for (const Bone& bone : rig.rig.skeleton.bones)
      require(bone.length > 0 && bone.rest.origin.allFinite() && bone.rest.rotation.allFinite() &&
              is_one_line(bone.name));
    for (const Clip& clip : rig.rig.clips) require(is_one_line(clip.name));
  });
}

}  // namespace sinew::fuzz
