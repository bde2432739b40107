// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/vtk/vtk_mesh.h>
#include "sound_mesh.h"

namespace sinew::fuzz {

/// XML files as what they say to be, all others as legacy files.
void vtk(std::string_view bytes) {
  const char* name = "fuzz.vtk";
  if (bytes.starts_with('<')) {
    name = "fuzz.vtu";
    if (bytes.find("type=\"PolyData\"") != bytes.npos) name = "fuzz.vtp";
    if (bytes.find("type=\"ImageData\"") != bytes.npos) name = "fuzz.vti";
  }
  const auto path = file_of(bytes, name);
  expect_sound_or_refused([&] { require_sound(read_vtk_mesh(path)); });
}

}  // namespace sinew::fuzz
