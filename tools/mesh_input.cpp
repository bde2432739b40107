// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh_input.h"

#include <algorithm>
#include <filesystem>

#include "core/stopwatch.h"
#include "io/gltf/read_gltf.h"
#include "mesh/mesh_text.h"
#include "mesh/prepare.h"
#include "mesh/read_surface.h"

namespace sinew {
namespace {

PolygonSoup read_any(const std::string& path) {
  const std::string extension = lower(std::filesystem::path(path).extension().string());
  return extension == ".gltf" || extension == ".glb" ? read_gltf(path) : read_polygons(path);
}

}  // namespace

Surface read_body_mesh(const BodySettings& body) {
  Stopwatch watch;
  PolygonSoup soup = read_any(body.mesh);
  const double reading = watch.lap();
  try {
    Surface surface = prepare(std::move(soup), body);
    surface.seconds_reading = reading;
    surface.seconds_cleaning = watch.lap();
    return surface;
  } catch (const Error& error) {
    throw error.within({body.mesh});
  }
}

}  // namespace sinew
