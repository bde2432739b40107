// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/binding.h"

#include <algorithm>
#include <cmath>

#include "core/number_text.h"
#include "core/words.h"
#include "io/gltf/read_rig.h"
#include "scene/body.h"

namespace sinew {
namespace {

/// The weights of the mesh in skeleton.file, as the rig stands in the scene.
BoneWeights weights_of_file(const Settings& settings, const Points& rest) {
  const std::filesystem::path file = settings.skeleton.file;
  const std::string type = lower(file.extension().string());
  const Place place = settings.place("binding.method");
  if (type != ".gltf" && type != ".glb")
    throw bad_input(place, "there is no glTF file to take weights from",
                    "name a .gltf or .glb with a skinned mesh in skeleton.file, or choose inside");
  GltfRig rig = told_at(settings, "skeleton.file", [&] { return read_gltf_rig(file); });
  if (rig.weights.weights.empty())
    throw bad_input(place, file.filename().string() + " holds no skinned mesh, so no weights",
                    "choose nearest or inside");
  const Mat3 turn = to_scene(settings.skeleton);
  for (Vec3& point : rig.mesh.points) point = settings.skeleton.scale * (turn * point);
  return carried_weights(rig.mesh.points, rig.weights, rest);
}

int bone_named(const Settings& settings, const std::string& path, const Skeleton& skeleton,
               const std::string& name) {
  if (name.empty()) return no_bone;
  std::vector<std::string_view> names;
  for (const Bone& bone : skeleton.bones) names.emplace_back(bone.name);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw bad_input(settings.place(path), "no bone is named '" + name + "'",
                    suggestion(name, names));
  return static_cast<int>(found - names.begin());
}

std::vector<std::uint32_t> ids_of(const Settings& settings, const std::string& path,
                                  const std::vector<double>& numbers, std::size_t particles) {
  std::vector<std::uint32_t> ids;
  for (const double number : numbers) {
    if (number != std::floor(number) || number >= static_cast<double>(particles))
      throw bad_input(settings.place(path), "there is no particle " + number_text(number),
                      "give whole numbers from 0 to " + std::to_string(particles - 1));
    ids.push_back(static_cast<std::uint32_t>(number));
  }
  std::sort(ids.begin(), ids.end());
  return ids;
}

BoundRegion region_of(const Settings& settings, std::size_t index, const Skeleton& skeleton,
                      std::size_t particles) {
  const BoundSettings& given = settings.bound[index];
  const std::string path = "binding.explicit[" + std::to_string(index) + "]";
  const bool box = given.low && given.high, ball = given.centre && given.radius;
  if (given.low.has_value() != given.high.has_value())
    throw bad_input(settings.place(path), "the box has one corner", "give both low and high");
  if (given.centre.has_value() != given.radius.has_value())
    throw bad_input(settings.place(path), "the ball lacks its centre or its radius",
                    "give both centre and radius");
  if (!box && !ball && !given.ids)
    throw bad_input(settings.place(path), "the entry names no particles",
                    "give ids, low and high of a box, or centre and radius of a ball");
  BoundRegion region;
  region.bone = bone_named(settings, path + ".bone", skeleton, given.bone);
  if (given.ids) region.ids = ids_of(settings, path + ".ids", *given.ids, particles);
  if (box) region.box = Box(*given.low, *given.high);
  if (ball) region.centre = *given.centre, region.radius = *given.radius;
  return region;
}

}  // namespace

Binding bind_scene(const Settings& settings, const Skeleton& skeleton, const Points& rest,
                   double radius) {
  const BindingSettings& given = settings.binding;
  BindOptions options;
  options.radius = radius;
  options.inside = given.method == BindMethod::inside;
  options.joint_zone = given.joint_zone;
  if (given.core_radius) options.core_radius = *given.core_radius;
  for (std::size_t i = 0; i < settings.bound.size(); ++i)
    options.regions.push_back(region_of(settings, i, skeleton, rest.size()));
  if (given.method == BindMethod::file) options.weights = weights_of_file(settings, rest);
  return bind_to_bones(rest, skeleton, options);
}

}  // namespace sinew
