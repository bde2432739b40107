// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/read_surface.h"

#include "mesh/cgal_soup.h"
#include "mesh/clean.h"
#include "mesh/plain_mesh.h"
#include "core/stopwatch.h"

namespace sinew {
namespace {

/// The guards have seen to all of this; a reader that errs must not take it further.
void refuse_unsound(const MeshFile& file, const PolygonSoup& soup) {
  const std::string cure = "export the mesh again";
  if (soup.polygons.empty()) throw file.broken(0, "there are no faces", cure);
  for (const Vec3& point : soup.points)
    if (!point.allFinite()) throw file.broken(0, "a coordinate is not finite", cure);
  for (const auto& polygon : soup.polygons) {
    if (polygon.size() < 3) throw file.broken(0, "a face has fewer than 3 corners", cure);
    for (const int corner : polygon)
      if (corner < 0 || static_cast<std::size_t>(corner) >= soup.points.size())
        throw file.broken(0,
                          "a face names vertex " + std::to_string(corner) + " of " +
                              std::to_string(soup.points.size()),
                          cure);
  }
}

}  // namespace

std::string plain_mesh(const MeshFile& file) {
  switch (file.format) {
    case MeshFormat::obj:
      return plain_obj(file);
    case MeshFormat::off:
      return plain_off(file);
    case MeshFormat::stl:
      return plain_stl(file);
    case MeshFormat::ply:
      return plain_ply(file);
  }
  return {};
}

PolygonSoup read_polygons(const std::string& path) {
  const MeshFile file = open_mesh(path);
  const auto soup = soup_by_cgal(file.format, plain_mesh(file));
  if (!soup) throw file.broken(0, "the mesh cannot be read", "export it again");
  refuse_unsound(file, *soup);
  return *soup;
}

Surface read_surface(const std::string& path) {
  Stopwatch watch;
  PolygonSoup soup = read_polygons(path);
  const double reading = watch.lap();
  try {
    Surface surface = clean(std::move(soup));
    surface.seconds_reading = reading;
    surface.seconds_cleaning = watch.lap();
    return surface;
  } catch (const Error& error) {
    throw error.within({path});
  }
}

}  // namespace sinew
