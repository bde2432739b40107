// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/mesh/read_surface.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <unordered_map>

#include <sinew/core/hash.h>
#include <sinew/core/text.h>
#include <sinew/mesh/readers/mesh_readers.h>

namespace sinew {
namespace {

using Place3 = std::array<std::uint64_t, 3>;  ///< the bits of a point

struct PlaceHash {
  std::size_t operator()(const Place3& place) const {
    Hash hash;
    hash.add(place.data(), sizeof place);
    return hash.value();
  }
};

Place3 bits_of(const Vec3& point) {
  Place3 place;
  for (int axis = 0; axis < 3; ++axis)
    place[axis] = std::bit_cast<std::uint64_t>(point[axis] + 0.0);  // no negative zero
  return place;
}

/// The polygons of a file by the places of their corners.
class PolygonsByPlace {
 public:
  explicit PolygonsByPlace(const PolygonSoup& soup) : soup_(soup) {
    for (std::size_t p = 0; p < soup.polygons.size(); ++p)
      for (const int point : soup.polygons[p]) at_[bits_of(soup.points[point])].push_back(p);
  }

  /// The first polygon with corners in all three places, and which these are; -1 for none.
  int find(const std::array<Vec3, 3>& places, std::array<std::size_t, 3>& corners) const {
    const std::vector<std::size_t>* fewest = nullptr;
    for (const Vec3& place : places) {
      const auto found = at_.find(bits_of(place));
      if (found == at_.end()) return -1;
      if (!fewest || found->second.size() < fewest->size()) fewest = &found->second;
    }
    for (const std::size_t polygon : *fewest)
      if (holds(soup_.polygons[polygon], places, corners)) return static_cast<int>(polygon);
    return -1;
  }

 private:
  bool holds(const std::vector<int>& polygon, const std::array<Vec3, 3>& places,
             std::array<std::size_t, 3>& corners) const {
    for (int k = 0; k < 3; ++k) {
      corners[k] = 0;
      while (corners[k] < polygon.size() && soup_.points[polygon[corners[k]]] != places[k])
        ++corners[k];
      if (corners[k] == polygon.size()) return false;
    }
    return true;
  }

  const PolygonSoup& soup_;
  std::unordered_map<Place3, std::vector<std::size_t>, PlaceHash> at_;
};

void add_face(const std::array<Vec3, 3>& places, const PolygonsByPlace& polygons,
              const ObjLook& file, SurfaceLook& look) {
  std::array<std::size_t, 3> corners{};
  std::array<int, 3> coordinates{-1, -1, -1};
  const int polygon = polygons.find(places, corners);
  if (polygon >= 0)
    for (int k = 0; k < 3; ++k) coordinates[k] = file.corners[polygon][corners[k]];
  const bool whole = std::all_of(coordinates.begin(), coordinates.end(), [&](int index) {
    return index >= 0 && index < static_cast<int>(file.coordinates.size());
  });
  look.corners.push_back(whole ? coordinates : std::array<int, 3>{-1, -1, -1});
  look.part.push_back(polygon < 0 ? -1 : file.part[polygon]);
}

}  // namespace

SurfaceLook look_of(const BodyOptions& body, const Triangles& surface) {
  const std::filesystem::path path = body.mesh;
  if (lower(path.extension().string()) != ".obj") return {};
  const MeshFile mesh = open_mesh(body.mesh);
  ObjLook file;
  PolygonSoup soup = read_obj(mesh, file);
  place(soup, body);
  SurfaceLook look;
  const PolygonsByPlace polygons(soup);
  for (const auto& [a, b, c] : surface.faces)
    add_face({surface.points[a], surface.points[b], surface.points[c]}, polygons, file, look);
  look.coordinates = std::move(file.coordinates);
  look.parts = std::move(file.parts);
  for (const std::string& library : file.libraries)
    look.libraries.push_back((path.parent_path() / library).string());
  return look;
}

}  // namespace sinew
