// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/read_surface.h"

#include <cmath>
#include <limits>
#include <utility>

#include "core/number_text.h"
#include "core/stopwatch.h"
#include "mesh/clean.h"
#include "mesh/mesh_readers.h"

namespace sinew {
namespace {

void check_polygon(const std::vector<int>& polygon, std::size_t points) {
  const std::string cure = "export the mesh again";
  if (polygon.size() < 3)
    throw bad_input("a face has " + std::to_string(polygon.size()) + " corners", cure);
  for (const int corner : polygon)
    if (corner < 0 || static_cast<std::size_t>(corner) >= points)
      throw bad_input("a face names vertex " + std::to_string(corner) + " of " +
                          std::to_string(points) + " (counted from 0)",
                      cure);
}

void scale(PolygonSoup& soup, double by) {
  if (!(by > 0) || !std::isfinite(by))
    throw bad_input("the scale is " + number_text(by), "give a number above 0");
  if (by == 1) return;
  for (Vec3& point : soup.points) point *= by;
}

}  // namespace

PolygonSoup read_polygons(const std::string& path) { return read_mesh(open_mesh(path)); }

void check_soup(const PolygonSoup& soup) {
  if (soup.polygons.empty())
    throw bad_input("there are no faces", "export the mesh with its faces");
  if (soup.points.size() > std::numeric_limits<int>::max())
    throw bad_input("there are " + std::to_string(soup.points.size()) + " points",
                    "reduce the number of triangles");
  for (std::size_t i = 0; i < soup.points.size(); ++i)
    if (!soup.points[i].allFinite())
      throw bad_input("vertex " + std::to_string(i) + " has a coordinate that is not finite",
                      "export the mesh again");
  for (const auto& polygon : soup.polygons) check_polygon(polygon, soup.points.size());
}

Surface surface_from(PolygonSoup soup, const ReadOptions& options) {
  Stopwatch watch;
  check_soup(soup);
  scale(soup, options.scale);
  Surface surface = clean(soup, {options.weld, options.rule});
  surface.seconds_cleaning = watch.lap();
  return surface;
}

Surface read_surface(const std::string& path, const ReadOptions& options) {
  Stopwatch watch;
  PolygonSoup soup = read_polygons(path);
  const double reading = watch.lap();
  try {
    Surface surface = surface_from(std::move(soup), options);
    surface.seconds_reading = reading;
    return surface;
  } catch (const Error& error) {
    throw error.within({path});
  }
}

}  // namespace sinew
