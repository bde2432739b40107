// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/check_soup.h"

#include <limits>
#include <string>

#include "core/error.h"

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

}  // namespace

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

}  // namespace sinew
