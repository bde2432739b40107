// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/mesh_input.h"

#include "core/words.h"

#include <algorithm>
#include <filesystem>

#include "io/gltf/read_gltf.h"
#include "mesh/read_surface.h"
#include "mesh/readers/mesh_text.h"

namespace sinew {
namespace {

PolygonSoup read_any(const std::string& path) {
  const std::string extension = lower(std::filesystem::path(path).extension().string());
  return extension == ".gltf" || extension == ".glb" ? read_gltf(path) : read_polygons(path);
}

}  // namespace

Surface read_body_mesh(const BodySettings& body) { return read_surface(body, read_any); }

}  // namespace sinew
