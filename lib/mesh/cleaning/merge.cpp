// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/cleaning/merge.h"

#include <utility>

#include "mesh/cleaning/first_of.h"
#include "mesh/cleaning/triangulate.h"
#include "mesh/cleaning/weld.h"

namespace sinew {
namespace {

using Face = std::array<int, 3>;

/// The same triangles wherever the polygon begins and whichever way it turns: polygons that double
/// each other are cut into triangles that do.
std::vector<Face> cut_alike(std::vector<int> polygon, const Points& points) {
  const auto at = [&](int i) { return std::tie(points[i][0], points[i][1], points[i][2]); };
  std::rotate(
      polygon.begin(),
      std::min_element(polygon.begin(), polygon.end(), [&](int a, int b) { return at(a) < at(b); }),
      polygon.end());
  const bool turned = at(polygon.back()) < at(polygon[1]);
  if (turned) std::reverse(polygon.begin() + 1, polygon.end());
  std::vector<Face> parts = triangulate(polygon, points);
  for (Face& part : parts)
    if (turned) std::swap(part[1], part[2]);
  return parts;
}

/// 1. Polygons into triangles.
std::vector<Face> cut(const PolygonSoup& soup, CleaningCounts& counts) {
  std::vector<Face> faces;
  faces.reserve(soup.polygons.size());
  for (const std::vector<int>& polygon : soup.polygons) {
    if (polygon.size() == 3) {
      faces.push_back({polygon[0], polygon[1], polygon[2]});
      continue;
    }
    ++counts.polygons_cut;
    for (const Face& part : cut_alike(polygon, soup.points)) faces.push_back(part);
  }
  return faces;
}

/// 2. Equal and close points become one.
void merge_points(std::vector<Face>& faces, const Points& points, double weld,
                  CleaningCounts& counts) {
  const std::vector<int> first = first_within(points, weld);
  for (std::size_t i = 0; i < first.size(); ++i)
    counts.points_merged += first[i] != static_cast<int>(i);
  for (Face& face : faces)
    for (int& corner : face) corner = first[corner];
}

/// 3. Faces that have lost a corner go.
void drop_collapsed(std::vector<Face>& faces, CleaningCounts& counts) {
  counts.faces_collapsed = std::erase_if(
      faces, [](const Face& f) { return f[0] == f[1] || f[1] == f[2] || f[2] == f[0]; });
}

Face sorted(Face face) {
  if (face[0] > face[1]) std::swap(face[0], face[1]);
  if (face[1] > face[2]) std::swap(face[1], face[2]);
  if (face[0] > face[1]) std::swap(face[0], face[1]);
  return face;
}

/// 4. Of faces with the same corners the first stays.
void drop_doubled(std::vector<Face>& faces, CleaningCounts& counts) {
  FirstOf first_of(faces.size());
  int kept = 0;
  for (const Face& face : faces) {
    const Face corners = sorted(face);
    std::uint64_t hash = 0;
    for (const int corner : corners) hash = mixed(hash, static_cast<std::uint64_t>(corner));
    const int first = first_of.find_or_add(
        hash, kept, [&](int other) { return sorted(faces[other]) == corners; });
    if (first == kept) faces[kept++] = face;
  }
  counts.faces_doubled = faces.size() - kept;
  faces.resize(kept);
}

/// 5. Points that no face uses go; the others keep their order.
Triangles used(const Points& points, std::vector<Face> faces, CleaningCounts& counts) {
  std::vector<int> place(points.size(), -1);
  for (const Face& face : faces)
    for (const int corner : face) place[corner] = 0;
  Triangles triangles;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (place[i] < 0) continue;
    place[i] = static_cast<int>(triangles.points.size());
    triangles.points.push_back(points[i]);
  }
  counts.points_unused = points.size() - counts.points_merged - triangles.points.size();
  for (Face& face : faces)
    for (int& corner : face) corner = place[corner];
  triangles.faces = std::move(faces);
  return triangles;
}

}  // namespace

Triangles merged_triangles(const PolygonSoup& soup, double weld, CleaningCounts& counts) {
  counts.points_read = soup.points.size();
  counts.polygons_read = soup.polygons.size();
  std::vector<Face> faces = cut(soup, counts);
  merge_points(faces, soup.points, weld, counts);
  drop_collapsed(faces, counts);
  drop_doubled(faces, counts);
  return used(soup.points, std::move(faces), counts);
}

}  // namespace sinew
