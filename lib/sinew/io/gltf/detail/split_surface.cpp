// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/detail/split_surface.h>

#include <array>
#include <map>
#include <numeric>
#include <utility>

#include <sinew/core/decompositions.h>

namespace sinew {
namespace {

/// What distinguishes vertices: point, coordinates, normal, element of the layers.
using VertexKey = std::array<int, 4>;
using PlaceOfNormal = std::pair<int, std::array<double, 3>>;  ///< point, direction

class Splitting {
 public:
  Splitting(std::size_t points, const SurfaceLook& look) : look_(look) {
    out_.has_normals = !look.normals.empty();
    for (const SurfaceLook::Layer& layer : look.layers)
      out_.layers.push_back({layer.name, layer.components, {}});
    if (!is_plain()) return;
    for (std::size_t i = 0; i < points; ++i) vertex({static_cast<int>(i), -1, -1, -1});
  }

  void add(std::size_t face, const std::array<int, 3>& corners) {
    std::vector<std::uint32_t>& patch = patch_of(face).corners;
    const SurfaceLook::Corners none{-1, -1, -1};
    const auto of = [&](const std::vector<SurfaceLook::Corners>& all) {
      return all.empty() ? none : all[face];
    };
    const auto coordinates = of(look_.corners), normals = of(look_.normal_corners),
               layers = of(look_.layer_corners);
    for (int k = 0; k < 3; ++k)
      patch.push_back(vertex({corners[k], coordinates[k], normals[k], layers[k]}));
  }

  SplitSurface done() { return std::move(out_); }

 private:
  bool is_plain() const {
    return look_.coordinates.empty() && look_.normals.empty() && look_.layers.empty();
  }

  SplitSurface::Patch& patch_of(std::size_t face) {
    const int part = look_.part.empty() ? -1 : look_.part[face];
    std::pair<int, std::string> key{-1, ""};
    if (part >= 0) {
      const SurfaceLook::Part& its = look_.parts[static_cast<std::size_t>(part)];
      key = {its.gltf_material, its.material};
    }
    const auto [found, is_new] = patches_.try_emplace(key, out_.patches.size());
    if (is_new) out_.patches.push_back({key.second, key.first, {}});
    return out_.patches[found->second];
  }

  std::uint32_t vertex(const VertexKey& key) {
    const auto [found, is_new] =
        vertices_.try_emplace(key, static_cast<std::uint32_t>(out_.point.size()));
    if (is_new) add_vertex(key);
    return found->second;
  }

  void add_vertex(const VertexKey& key) {
    const auto& [point, coordinates, normal, element] = key;
    out_.point.push_back(point);
    if (!look_.coordinates.empty()) {
      const std::array<double, 2> none{0, 1};
      const auto& [u, v] =
          coordinates < 0 ? none : look_.coordinates[static_cast<std::size_t>(coordinates)];
      out_.coordinates.push_back(static_cast<float>(u));
      out_.coordinates.push_back(static_cast<float>(1 - v));
    }
    if (out_.has_normals) out_.smooth.push_back(normal_at(point, normal));
    for (std::size_t k = 0; k < look_.layers.size(); ++k)
      add_values(look_.layers[k], element, out_.layers[k].values);
  }

  /// White, or zero, where there is none.
  static void add_values(const SurfaceLook::Layer& layer, int element, std::vector<float>& values) {
    const float missing = layer.name.starts_with("COLOR_") ? 1 : 0;
    for (int c = 0; c < layer.components; ++c)
      values.push_back(
          element < 0 ? missing
                      : layer.values[static_cast<std::size_t>(element * layer.components + c)]);
  }

  /// Vertices of one point with equal normals have one.
  std::size_t normal_at(int point, int index) {
    const Vec3 normal =
        index < 0 ? Vec3(Vec3::Zero()) : look_.normals[static_cast<std::size_t>(index)];
    const PlaceOfNormal key{point, {normal.x() + 0.0, normal.y() + 0.0, normal.z() + 0.0}};
    const auto [found, is_new] = normals_.try_emplace(key, out_.normals.size());
    if (is_new) out_.normals.push_back(normal);
    return found->second;
  }

  const SurfaceLook& look_;
  SplitSurface out_;
  std::map<VertexKey, std::uint32_t> vertices_;
  std::map<PlaceOfNormal, std::size_t> normals_;
  std::map<std::pair<int, std::string>, std::size_t> patches_;
};

Vec3 place_of(const std::vector<float>& places, std::uint32_t vertex) {
  const std::size_t at = 3 * static_cast<std::size_t>(vertex);
  return {places[at], places[at + 1], places[at + 2]};
}

}  // namespace

SplitSurface split_surface(const std::vector<std::array<int, 3>>& faces, std::size_t points,
                           const SurfaceLook& look) {
  Splitting splitting(points, look);
  for (std::size_t face = 0; face < faces.size(); ++face) splitting.add(face, faces[face]);
  return splitting.done();
}

MovedNormals::MovedNormals(const SplitSurface& surface, const std::vector<float>& at_rest,
                           Points given)
    : surface_(surface), given_(std::move(given)), at_rest_(means(at_rest)) {}

/// Averages the faces around each normal, by their areas; zero where they have none.
Points MovedNormals::means(const std::vector<float>& places) const {
  Points means(surface_.normals.size(), Vec3::Zero());
  for (const SplitSurface::Patch& patch : surface_.patches)
    for (std::size_t i = 0; i < patch.corners.size(); i += 3) {
      const Vec3 a = place_of(places, patch.corners[i]), b = place_of(places, patch.corners[i + 1]),
                 c = place_of(places, patch.corners[i + 2]);
      const Vec3 across = (b - a).cross(c - a);
      for (std::size_t k = i; k < i + 3; ++k) means[surface_.smooth[patch.corners[k]]] += across;
    }
  for (Vec3& mean : means) mean = direction_of(mean);
  return means;
}

std::vector<float> MovedNormals::at(const std::vector<float>& places) const {
  Points normals = means(places);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    if (given_[i].isZero(0)) continue;
    const bool turns = !normals[i].isZero(0) && !at_rest_[i].isZero(0);
    normals[i] = turns ? shortest_rotation(at_rest_[i], normals[i]) * given_[i] : given_[i];
  }
  std::vector<float> out;
  out.reserve(3 * surface_.smooth.size());
  for (const std::size_t normal : surface_.smooth) {
    const Vec3 upright = normals[normal].isZero(0) ? Vec3(Vec3::UnitY()) : normals[normal];
    for (const double part : upright) out.push_back(static_cast<float>(part));
  }
  return out;
}

}  // namespace sinew
