// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/cgal_soup.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/OBJ.h>
#include <CGAL/IO/OFF.h>
#include <CGAL/IO/PLY.h>
#include <CGAL/IO/STL.h>

#include <exception>
#include <sstream>

namespace sinew {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

struct CgalSoup {
  std::vector<Kernel::Point_3> points;
  std::vector<std::vector<int>> polygons;
};

bool read(MeshFormat format, std::istream& in, CgalSoup& soup) {
  const auto quiet = CGAL::parameters::verbose(false);
  switch (format) {
    case MeshFormat::obj:
      return CGAL::IO::read_OBJ(in, soup.points, soup.polygons, quiet);
    case MeshFormat::off:
      return CGAL::IO::read_OFF(in, soup.points, soup.polygons, quiet);
    case MeshFormat::stl:
      return CGAL::IO::read_STL(in, soup.points, soup.polygons, quiet);
    case MeshFormat::ply:
      return CGAL::IO::read_PLY(in, soup.points, soup.polygons, quiet);
  }
  return false;
}

}  // namespace

std::optional<PolygonSoup> soup_by_cgal(MeshFormat format, std::string plain) {
  CgalSoup read_soup;
  try {
    std::istringstream in(std::move(plain));
    if (!read(format, in, read_soup)) return std::nullopt;
  } catch (const std::exception&) {
    return std::nullopt;
  }
  PolygonSoup soup{{}, std::move(read_soup.polygons)};
  soup.points.reserve(read_soup.points.size());
  for (const Kernel::Point_3& point : read_soup.points)
    soup.points.emplace_back(point.x(), point.y(), point.z());
  return soup;
}

}  // namespace sinew
