// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/triangles.h>
#include <sinew/mesh/readers/mesh_readers.h>
#include "sound_mesh.h"

namespace sinew::fuzz {
namespace {

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

}  // namespace sinew::fuzz
