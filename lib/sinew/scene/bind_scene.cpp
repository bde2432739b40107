// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/bind_scene.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>

#include <sinew/core/error.h>
#include <sinew/core/text.h>
#include <sinew/io/gltf/geometry.h>
#include <sinew/mesh/refine.h>
#include <sinew/rig/skinning.h>
#include <sinew/scene/context.h>
#include <sinew/scene/particle_parts.h>
#include <sinew/scene/rig.h>

namespace sinew {

namespace {

/// The weights of a skin and of points between its vertices, so that all of it is near one: the
/// corners of a long box may be nearer to another limb than to what the box holds.
struct DenseSkin {
  Points points;
  BoneWeights weights;
};

/// Adds the mean of the weights of two points, or those of the one that has any.
void append_mean(const std::array<int, 2>& ends, BoneWeights& weights) {
  std::vector<BoneWeight> mean;
  double sum = 0;
  for (const int end : ends)
    for (const BoneWeight& one : weights.of(static_cast<std::size_t>(end))) {
      sum += one.weight;
      const auto same = std::find_if(mean.begin(), mean.end(), [&](const BoneWeight& other) {
        return other.bone == one.bone;
      });
      if (same == mean.end())
        mean.push_back(one);
      else
        same->weight += one.weight;
    }
  for (BoneWeight& one : mean) one.weight /= sum;
  weights.weights.insert(weights.weights.end(), mean.begin(), mean.end());
  weights.first.push_back(static_cast<std::uint32_t>(weights.weights.size()));
}

Triangles triangles_of(const PolygonSoup& soup) {
  Triangles triangles{soup.points, {}};
  for (const std::vector<int>& polygon : soup.polygons)
    for (std::size_t k = 2; k < polygon.size(); ++k)
      triangles.faces.push_back({polygon[0], polygon[k - 1], polygon[k]});
  return triangles;
}

/// Faces that reach into a box.
std::vector<std::array<int, 3>> faces_in(const Triangles& skin, const Box& box) {
  std::vector<std::array<int, 3>> faces;
  for (const auto& [a, b, c] : skin.faces) {
    Box around(skin.points[a]);
    if (box.intersects(around.extend(skin.points[b]).extend(skin.points[c])))
      faces.push_back({a, b, c});
  }
  return faces;
}

/// Near the body (a box, m) points of `skin` (m) are a few radii apart at most. Elsewhere, as on a
/// ground of kilometers, there are few: what is cut off from the body is not cut further.
DenseSkin dense_skin(Triangles skin, BoneWeights weights, const Box& body, double radius) {
  constexpr double apart = 4, shorter = 4;  // in radii; from one cut to the next
  const Vec3 margin = Vec3::Constant(apart * radius);
  const Box near(body.min() - margin, body.max() + margin);
  std::vector<std::array<int, 2>> ends;
  for (double side = longest_side(skin); side > apart * radius;) {
    side = std::max(apart * radius, side / shorter);
    skin.faces = faces_in(skin, near);
    skin = refined(std::move(skin), side, &ends);
  }
  DenseSkin dense{std::move(skin.points), std::move(weights)};
  for (const std::array<int, 2>& two : ends) append_mean(two, dense.weights);
  return dense;
}

/// The weights of the mesh in skeleton.file, in the scene's directions and lengths.
BoneWeights weights_of_file(const Settings& settings, const SkinnedRig& rig, const Points& rest,
                            double radius) {
  const std::filesystem::path file = settings.skeleton.file;
  const Place place = settings.place("binding.method");
  if (!is_gltf(file))
    throw bad_input(
        place, "there is no glTF file to take weights from",
        "name a .gltf, .glb or .vrm with a skinned mesh in skeleton.file, or choose inside");
  if (rig.weights.weights.empty())
    throw bad_input(place, file.filename().string() + " holds no skinned mesh, so no weights",
                    "choose nearest or inside");
  const Placement placement = placement_of(settings.skeleton);
  PolygonSoup mesh = rig.mesh;
  for (Vec3& point : mesh.points) point = placement(point);
  const DenseSkin skin = dense_skin(triangles_of(mesh), rig.weights, bounds(rest), radius);
  return carried_weights(skin.points, skin.weights, rest);
}

void refuse_empty(const BoundRegion& region, const Points& rest, const Place& place) {
  for (std::size_t i = 0; i < rest.size(); ++i)
    if (region.holds(i, rest[i])) return;
  const Box body = bounds(rest);
  const auto corner = [](const Vec3& point) {
    return '[' + three_digits(point.x()) + ", " + three_digits(point.y()) + ", " +
           three_digits(point.z()) + ']';
  };
  throw bad_input(place, "there is no particle in this region",
                  "choose one that reaches into the body, from " + corner(body.min()) + " to " +
                      corner(body.max()) + " m");
}

BoundRegion region_of(const Settings& settings, std::size_t index, const Skeleton& skeleton,
                      const Points& rest) {
  const BoundSettings& given = settings.bound[index];
  const std::string path = "binding.explicit[" + std::to_string(index) + "]";
  const bool box = given.low && given.high, ball = given.center && given.radius;
  if (given.low.has_value() != given.high.has_value())
    throw bad_input(settings.place(path), "the box has one corner", "give both low and high");
  if (given.center.has_value() != given.radius.has_value())
    throw bad_input(settings.place(path), "the ball lacks its center or its radius",
                    "give both center and radius");
  if (!box && !ball && !given.ids)
    throw bad_input(settings.place(path), "the entry names no particles",
                    "give ids, low and high of a box, or center and radius of a ball");
  BoundRegion region;
  region.bone = bone_at(settings, path, skeleton, given.bone);
  if (given.ids) region.ids = ids_of(settings, path + ".ids", *given.ids, rest.size());
  if (box) region.box = Box(*given.low, *given.high);
  if (ball) region.center = *given.center, region.radius = *given.radius;
  refuse_empty(region, rest, settings.place(path));
  return region;
}

}  // namespace

Binding bind_scene(const Settings& settings, const SceneFiles& files, const Skeleton& skeleton,
                   const Points& rest, const NeighborLists& nearest, double radius) {
  const BindingOptions& given = settings.binding;
  BindOptions options;
  options.radius = radius;
  options.neighbors = &nearest;
  options.inside = given.method == BindMethod::inside;
  options.joint_zone = given.joint_zone;
  if (given.core_radius) options.core_radius = *given.core_radius;
  for (std::size_t i = 0; i < settings.bound.size(); ++i)
    options.regions.push_back(region_of(settings, i, skeleton, rest));
  if (given.method == BindMethod::file)
    options.weights = weights_of_file(settings, files.skeleton, rest, radius);
  return bind_to_bones(rest, skeleton, options);
}

}  // namespace sinew
