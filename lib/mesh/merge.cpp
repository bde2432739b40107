// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/merge.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <unordered_set>

#include "core/hash.h"
#include "mesh/triangulate.h"

namespace sinew {
namespace {

using Face = std::array<int, 3>;

/// 1. Polygons into triangles.
std::vector<Face> cut(const PolygonSoup& soup, CleaningCounts& counts) {
  std::vector<Face> faces;
  faces.reserve(soup.polygons.size());
  for (const std::vector<int>& polygon : soup.polygons) {
    if (polygon.size() > 3) ++counts.polygons_cut;
    const auto parts = triangulate(polygon, soup.points);
    faces.insert(faces.end(), parts.begin(), parts.end());
  }
  return faces;
}

/// For each point the first point equal to it.
std::vector<int> first_equal(const Points& points) {
  std::vector<int> order(points.size()), first(points.size());
  std::iota(order.begin(), order.end(), 0);
  const auto before = [&](int a, int b) {
    const auto& p = points[a];
    const auto& q = points[b];
    return std::tie(p[0], p[1], p[2], a) < std::tie(q[0], q[1], q[2], b);
  };
  std::sort(order.begin(), order.end(), before);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool repeated = i > 0 && points[order[i]] == points[order[i - 1]];
    first[order[i]] = repeated ? first[order[i - 1]] : order[i];
  }
  return first;
}

/// 2. Equal points become one.
void merge_points(std::vector<Face>& faces, const Points& points, CleaningCounts& counts) {
  const std::vector<int> first = first_equal(points);
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

struct FaceHash {
  std::size_t operator()(const Face& face) const {
    Hash hash;
    hash.add(face.data(), sizeof face);
    return hash.value();
  }
};

/// 4. Of faces with the same corners the first stays.
void drop_doubled(std::vector<Face>& faces, CleaningCounts& counts) {
  std::unordered_set<Face, FaceHash> seen(2 * faces.size());
  counts.faces_doubled = std::erase_if(faces, [&](Face face) {
    std::sort(face.begin(), face.end());
    return !seen.insert(face).second;
  });
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

Triangles merged_triangles(PolygonSoup soup, CleaningCounts& counts) {
  counts.points_read = soup.points.size();
  counts.polygons_read = soup.polygons.size();
  std::vector<Face> faces = cut(soup, counts);
  merge_points(faces, soup.points, counts);
  drop_collapsed(faces, counts);
  drop_doubled(faces, counts);
  return used(soup.points, std::move(faces), counts);
}

}  // namespace sinew
