// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/vtk/detail/grids.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <tuple>
#include <utility>

#include <sinew/core/error.h>
#include <sinew/core/text.h>

namespace sinew {
namespace {

using Ids = std::vector<int>;

struct Side {
  int a, b, middle;
};

/// A kind of volume cells: the corners of its faces, counter-clockwise seen from outside, and the
/// nodes in the middle of its sides.
struct Solid {
  int type;
  std::size_t points;  ///< at least
  std::vector<Ids> faces;
  std::vector<Side> sides = {};
};

const std::vector<Ids>& hexahedron() {
  static const std::vector<Ids> faces = {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4},
                                         {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}};
  return faces;
}

/// Follows VTK's documentation of its cell types.
const std::vector<Solid>& solids() {
  static const std::vector<Ids> tetrahedron = {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {0, 2, 1}},
                                wedge = {{0, 1, 2},
                                         {3, 5, 4},
                                         {0, 3, 4, 1},
                                         {1, 4, 5, 2},
                                         {2, 5, 3, 0}},
                                pyramid = {
                                    {0, 3, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  static const std::vector<Side> of_hexahedron = {{0, 1, 8},  {1, 2, 9},  {2, 3, 10}, {3, 0, 11},
                                                  {4, 5, 12}, {5, 6, 13}, {6, 7, 14}, {7, 4, 15},
                                                  {0, 4, 16}, {1, 5, 17}, {2, 6, 18}, {3, 7, 19}};
  static const std::vector<Solid> all = {
      {10, 4, tetrahedron},
      {11, 8, {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}},
      {12, 8, hexahedron()},
      {13, 6, wedge},
      {14, 5, pyramid},
      {24, 10, tetrahedron, {{0, 1, 4}, {1, 2, 5}, {2, 0, 6}, {0, 3, 7}, {1, 3, 8}, {2, 3, 9}}},
      {25, 20, hexahedron(), of_hexahedron},
      {26,
       15,
       wedge,
       {{0, 1, 6},
        {1, 2, 7},
        {2, 0, 8},
        {3, 4, 9},
        {4, 5, 10},
        {5, 3, 11},
        {0, 3, 12},
        {1, 4, 13},
        {2, 5, 14}}},
      {27,
       13,
       pyramid,
       {{0, 1, 5}, {1, 2, 6}, {2, 3, 7}, {3, 0, 8}, {0, 4, 9}, {1, 4, 10}, {2, 4, 11}, {3, 4, 12}}},
      {29, 27, hexahedron(), of_hexahedron}};
  return all;
}

const Solid* solid_of(int type) {
  const auto found = std::find_if(solids().begin(), solids().end(),
                                  [&](const Solid& solid) { return solid.type == type; });
  return found == solids().end() ? nullptr : &*found;
}

Error damaged(std::size_t cell, const std::string& what) {
  return bad_input("cell " + std::to_string(cell) + ' ' + what, "write the file again");
}

bool is_line_or_less(int type) { return (type >= 0 && type <= 4) || type == 21 || type == 35; }

bool is_polygon(int type) {
  constexpr std::array<int, 9> polygons = {5, vtk_strip, vtk_polygon, 8, 9, 22, 23, 28, 34};
  return std::find(polygons.begin(), polygons.end(), type) != polygons.end();
}

void check_type(int type) {
  if (is_line_or_less(type) || is_polygon(type) || solid_of(type) != nullptr) return;
  throw bad_input("it holds cells of VTK's type " + std::to_string(type) +
                      ", which are not read (polyhedra, cells of higher order)",
                  "save its surface: in ParaView, Extract Surface and Triangulate");
}

/// The cells with their types and points checked.
class Checked {
 public:
  Checked(const VtkCells& cells, std::size_t points) : cells_(cells) {
    if (cells.ends.size() != cells.types.size())
      throw bad_input("it has " + std::to_string(cells.types.size()) + " types of " +
                          std::to_string(cells.ends.size()) + " cells",
                      "write the file again");
    std::int64_t last = 0;
    for (std::size_t i = 0; i < size(); ++i) {
      check_type(cells.types[i]);
      if (cells.ends[i] < last || cells.ends[i] > static_cast<std::int64_t>(cells.points.size()))
        throw damaged(i, "ends outside of the list of points");
      last = cells.ends[i];
      for (const std::int64_t id : (*this)[i])
        if (id < 0 || id >= static_cast<std::int64_t>(points))
          throw damaged(i, "names point " + std::to_string(id) + " of " + std::to_string(points));
    }
  }

  std::size_t size() const { return cells_.types.size(); }
  int type(std::size_t i) const { return cells_.types[i]; }

  std::span<const std::int64_t> operator[](std::size_t i) const {
    const std::int64_t begin = i == 0 ? 0 : cells_.ends[i - 1];
    return std::span(cells_.points)
        .subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(cells_.ends[i] - begin));
  }

 private:
  const VtkCells& cells_;
};

/// Returns the points at those places of a cell. Throws bad input where it has fewer.
Ids picked(const Checked& cells, std::size_t cell, std::initializer_list<int> places) {
  const auto points = cells[cell];
  Ids ids;
  for (const int place : places) {
    if (static_cast<std::size_t>(place) >= points.size())
      throw damaged(cell, "has " + std::to_string(points.size()) + " points, too few");
    ids.push_back(static_cast<int>(points[static_cast<std::size_t>(place)]));
  }
  return ids;
}

void add_strip(const Checked& cells, std::size_t cell, std::vector<Ids>& polygons) {
  const int count = static_cast<int>(cells[cell].size());
  for (int i = 0; i + 2 < count; ++i)
    polygons.push_back(picked(cells, cell, {i, i + 1 + i % 2, i + 2 - i % 2}));
}

/// Adds a cell that is a surface.
void add_polygon(const Checked& cells, std::size_t cell, std::vector<Ids>& polygons) {
  const int type = cells.type(cell);
  const auto points = cells[cell];
  if (type == vtk_strip) return add_strip(cells, cell, polygons);
  if (type == 5) return polygons.push_back(picked(cells, cell, {0, 1, 2}));
  if (type == 8) return polygons.push_back(picked(cells, cell, {0, 1, 3, 2}));
  if (type == 9) return polygons.push_back(picked(cells, cell, {0, 1, 2, 3}));
  if (type == 22 || type == 34) return polygons.push_back(picked(cells, cell, {0, 3, 1, 4, 2, 5}));
  if (type == 23 || type == 28)
    return polygons.push_back(picked(cells, cell, {0, 4, 1, 5, 2, 6, 3, 7}));
  if (type != vtk_polygon) return;
  picked(cells, cell, {0, 1, 2});  // it must have them
  polygons.emplace_back(points.begin(), points.end());
}

struct Face {
  std::array<int, 4> key;  ///< its corners in the order of their numbers
  std::size_t cell;
  std::size_t face;
};

/// Finds faces of volume cells that belong to one cell only, in the order of the cells.
std::vector<Face> outer_faces(const Checked& cells) {
  std::vector<Face> all;
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    const Solid* solid = solid_of(cells.type(cell));
    if (solid == nullptr) continue;
    if (cells[cell].size() < solid->points)
      throw damaged(cell, "has " + std::to_string(cells[cell].size()) + " points, too few");
    for (std::size_t face = 0; face < solid->faces.size(); ++face) {
      std::array<int, 4> key = {-1, -1, -1, -1};
      std::size_t place = 0;
      for (const int corner : solid->faces[face])
        key[place++] = static_cast<int>(cells[cell][static_cast<std::size_t>(corner)]);
      std::sort(key.begin(), key.end());
      all.push_back({key, cell, face});
    }
  }
  std::sort(all.begin(), all.end(), [](const Face& a, const Face& b) {
    return std::tie(a.key, a.cell, a.face) < std::tie(b.key, b.cell, b.face);
  });
  std::vector<Face> outer;
  for (std::size_t i = 0; i < all.size(); ++i)
    if ((i == 0 || all[i - 1].key != all[i].key) &&
        (i + 1 == all.size() || all[i + 1].key != all[i].key))
      outer.push_back(all[i]);
  std::sort(outer.begin(), outer.end(), [](const Face& a, const Face& b) {
    return std::tie(a.cell, a.face) < std::tie(b.cell, b.face);
  });
  return outer;
}

/// The corners of a face, with the nodes between them.
Ids polygon_of(const Checked& cells, const Face& face) {
  const Solid& solid = *solid_of(cells.type(face.cell));
  const Ids& corners = solid.faces[face.face];
  Ids ids;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const int a = corners[i], b = corners[(i + 1) % corners.size()];
    ids.push_back(picked(cells, face.cell, {a}).front());
    for (const Side& side : solid.sides)
      if (std::minmax(side.a, side.b) == std::minmax(a, b))
        ids.push_back(picked(cells, face.cell, {side.middle}).front());
  }
  return ids;
}

}  // namespace

std::vector<std::vector<int>> surface_of(const VtkCells& cells, std::size_t points) {
  const Checked checked(cells, points);
  std::vector<Ids> polygons;
  for (const Face& face : outer_faces(checked)) polygons.push_back(polygon_of(checked, face));
  if (!polygons.empty()) return polygons;
  for (std::size_t cell = 0; cell < checked.size(); ++cell) add_polygon(checked, cell, polygons);
  if (polygons.empty())
    throw bad_input(
        "none of its " + std::to_string(checked.size()) + " cells is a surface or a volume",
        "give a file with triangles, polygons or volume cells");
  return polygons;
}

namespace {

bool is_left_out(std::uint8_t flags) {
  constexpr int duplicate = 1, hidden = 32;
  return (flags & (duplicate | hidden)) != 0;
}

/// The cells that `wanted` selects by their place; none of damaged ones.
template <class Wanted>
std::optional<VtkCells> cells_where(const VtkCells& cells, const Wanted& wanted) {
  VtkCells some;
  std::int64_t begin = 0;
  for (std::size_t i = 0; i < cells.ends.size(); ++i) {
    const std::int64_t end = cells.ends[i];
    if (end < begin || end > static_cast<std::int64_t>(cells.points.size())) return std::nullopt;
    if (wanted(i)) {
      some.types.push_back(cells.types[i]);
      some.points.insert(some.points.end(), cells.points.begin() + begin,
                         cells.points.begin() + end);
      some.ends.push_back(static_cast<std::int64_t>(some.points.size()));
      if (i < cells.materials.size()) some.materials.push_back(cells.materials[i]);
    }
    begin = end;
  }
  return some;
}

/// Removes the cells that are left out, none from damaged ones. Returns their number.
std::size_t drop_ghosts(VtkCells& cells) {
  const std::size_t count = cells.ends.size();
  if (std::none_of(cells.ghosts.begin(), cells.ghosts.end(), is_left_out)) return 0;
  if (cells.types.size() != count) return 0;
  auto shown = cells_where(cells, [&](std::size_t i) {
    return i >= cells.ghosts.size() || !is_left_out(cells.ghosts[i]);
  });
  if (!shown) return 0;
  cells = std::move(*shown);
  return count - cells.ends.size();
}

/// Pieces have points of their own where they meet: volume cells on both sides share a face.
void join_equal_points(const Points& points, VtkCells& cells) {
  std::map<std::array<double, 3>, std::int64_t> places;
  std::vector<std::int64_t> first(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3& p = points[i];
    first[i] = places.emplace(std::array{p.x(), p.y(), p.z()}, i).first->second;
  }
  for (std::int64_t& id : cells.points)
    if (id >= 0 && id < static_cast<std::int64_t>(first.size()))
      id = first[static_cast<std::size_t>(id)];
}

}  // namespace

void add_warning(PolygonSoup& soup, const std::string& warning) {
  soup.warning += (soup.warning.empty() || warning.empty() ? "" : "; ") + warning;
}

PolygonSoup soup_of(VtkGrid grid) {
  VtkCells& cells = grid.cells;
  const std::size_t all = cells.ends.size(), dropped = drop_ghosts(cells);
  if (dropped > 0 && dropped == all)
    throw bad_input("all of its " + std::to_string(all) + " cells are ghosts or hidden",
                    "give the file that holds the cells themselves");
  if (grid.pieces || dropped > 0) join_equal_points(grid.points, cells);
  PolygonSoup soup{std::move(grid.points), {}, {}};
  soup.polygons = surface_of(cells, soup.points.size());
  if (dropped > 0)
    soup.warning = "cells that are left out, as copies of another piece's (ghosts) or hidden: " +
                   std::to_string(dropped) + " of " + std::to_string(all);
  return soup;
}

bool names_materials(std::string_view array) {
  static constexpr std::array<std::string_view, 16> names = {
      "material",      "materials", "materialid",    "materialids",    "matid",  "mat",
      "partid",        "part",      "region",        "regionid",       "domain", "domainid",
      "gmsh:physical", "medit:ref", "cellentityids", "elementblockids"};
  std::string name = lower(array);
  std::erase_if(name, [](char letter) { return letter == '_' || letter == ' '; });
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::vector<MaterialSurface> materials_of(VtkGrid grid) {
  constexpr std::size_t max_materials = 64;
  VtkCells& cells = grid.cells;
  const bool joined = drop_ghosts(cells) > 0 || grid.pieces;
  if (cells.materials.size() != cells.ends.size() || cells.types.size() != cells.ends.size())
    return {};
  if (joined) join_equal_points(grid.points, cells);
  std::set<std::int64_t> numbers;
  for (std::size_t i = 0; i < cells.types.size(); ++i)
    if (solid_of(cells.types[i]) != nullptr) numbers.insert(cells.materials[i]);
  std::vector<MaterialSurface> materials;
  if (numbers.size() > max_materials) return materials;
  for (const std::int64_t number : numbers) {
    const auto own = cells_where(cells, [&](std::size_t i) {
      return cells.materials[i] == number && solid_of(cells.types[i]) != nullptr;
    });
    if (!own) return {};
    materials.push_back({number, {grid.points, surface_of(*own, grid.points.size()), {}}});
  }
  return materials;
}

}  // namespace sinew
