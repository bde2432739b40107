// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/repair/read_surface.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <unordered_map>

#include <sinew/core/file.h>
#include <sinew/core/hash.h>
#include <sinew/core/text.h>
#include <sinew/mesh/mesh_formats.h>

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
    if (!fewest) return -1;
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

/// Returns the corners of a face; none where one of them does not exist.
SurfaceLook::Corners picked(const PolygonLook::Corners& all, int polygon,
                            const std::array<std::size_t, 3>& corners, std::size_t there) {
  SurfaceLook::Corners picked{-1, -1, -1};
  if (polygon < 0 || all.empty()) return picked;
  for (int k = 0; k < 3; ++k) {
    picked[k] = all[static_cast<std::size_t>(polygon)][corners[k]];
    if (picked[k] < 0 || static_cast<std::size_t>(picked[k]) >= there) return {-1, -1, -1};
  }
  return picked;
}

std::size_t elements(const std::vector<SurfaceLook::Layer>& layers) {
  if (layers.empty()) return 0;
  return layers.front().values.size() / static_cast<std::size_t>(layers.front().components);
}

/// Adds the face at these places to the look.
void add_face(const std::array<Vec3, 3>& places, const PolygonsByPlace& polygons,
              const PolygonLook& file, SurfaceLook& look) {
  std::array<std::size_t, 3> corners{};
  const int polygon = polygons.find(places, corners);
  look.corners.push_back(picked(file.corners, polygon, corners, look.coordinates.size()));
  look.normal_corners.push_back(picked(file.normal_corners, polygon, corners, look.normals.size()));
  look.layer_corners.push_back(picked(file.layer_corners, polygon, corners, elements(look.layers)));
  look.part.push_back(polygon < 0 ? -1 : file.look.part[static_cast<std::size_t>(polygon)]);
}

/// The reader of a path's look; none where its format has none.
auto reader_of(const std::filesystem::path& path, std::span<const MeshFormat> more) {
  const std::string extension = lower(path.extension().string());
  PolygonSoup (*reader)(const std::string&, PolygonLook&) = nullptr;
  if (extension == ".obj") reader = read_obj_look;
  for (const MeshFormat& format : more)
    if (format.extension == extension) reader = format.read_look;
  return reader;
}

}  // namespace

SurfaceLook look_of(const BodyOptions& body, const Triangles& surface,
                    std::span<const MeshFormat> more) {
  const std::filesystem::path path = body.mesh;
  const auto reader = reader_of(path, more);
  if (!reader) return {};
  PolygonLook file;
  PolygonSoup soup = reader(body.mesh, file);
  place(soup, body);
  const PolygonsByPlace polygons(soup);
  SurfaceLook look = file.look;
  look.part.clear();
  for (Vec3& normal : look.normals) normal = placement_of(body).turn * normal;
  for (const auto& [a, b, c] : surface.faces)
    add_face({surface.points[a], surface.points[b], surface.points[c]}, polygons, file, look);
  for (std::string& library : look.libraries)
    library = file_below(path.parent_path(), library).string();
  std::erase(look.libraries, "");
  for (const std::string& library : look.libraries)
    for (SurfaceLook::Material& material : read_materials(library))
      look.materials.push_back(std::move(material));
  return look;
}

}  // namespace sinew
