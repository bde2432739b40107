// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/read_surface.h"

#include "core/stopwatch.h"
#include "mesh/prepare.h"
#include "mesh/readers/mesh_readers.h"

namespace sinew {

PolygonSoup read_polygons(const std::string& path) { return read_mesh(open_mesh(path)); }

Surface read_surface(const BodySettings& body, const MeshReader& reader) {
  Stopwatch watch;
  PolygonSoup soup = reader(body.mesh);
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
