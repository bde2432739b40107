// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/triangles.h>
#include <sinew/mesh/detail/readers/mesh_readers.h>
#include "sound_mesh.h"

namespace sinew::fuzz {
namespace {

void mesh(std::string_view bytes, PolygonSoup (*read)(const MeshFile&)) {
  expect_sound_or_refused([&] { require_sound(read({"fuzz.mesh", std::string(bytes)})); });
}

}  // namespace

void obj(std::string_view bytes) {
  mesh(bytes, read_obj);
  expect_sound_or_refused([&] {
    PolygonLook look;
    const PolygonSoup soup = read_obj({"fuzz.obj", std::string(bytes)}, look);
    require_sound(soup);
    require_sound(soup, look);
  });
  read_mtl(file_of(bytes, "fuzz.mtl").string());
}
void off(std::string_view bytes) { mesh(bytes, read_off); }
void ply(std::string_view bytes) { mesh(bytes, read_ply); }
void stl(std::string_view bytes) { mesh(bytes, read_stl); }

}  // namespace sinew::fuzz
