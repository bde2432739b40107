// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <set>
#include <utility>

#include <sinew/io/gltf/checks.h>

namespace sinew {
namespace {

void check_joints(const GltfDocument& document, const GltfSkin& skin, const std::string& user) {
  if (skin.joints.empty()) throw damaged_gltf(user + " has no joints");
  for (const int joint : skin.joints) check_index(joint, document.nodes, user, "node");
  if (skin.root >= 0) check_index(skin.root, document.nodes, user, "node");
  std::vector<int> sorted = skin.joints;
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  if (twice != sorted.end())
    throw damaged_gltf(user + " names node " + std::to_string(*twice) + " twice");
}

void check_binds(const GltfDocument& document, const GltfSkin& skin, const std::string& user) {
  if (skin.binds < 0) return;
  const GltfAccessor& binds = accessor_of(document, skin.binds, user + "'s inverse bind matrices");
  if (binds.type != "MAT4" || binds.number != GltfNumber::float32)
    throw damaged_gltf(user + "'s inverse bind matrices are not MAT4 of 5126");
  if (binds.count < static_cast<std::int64_t>(skin.joints.size()))
    throw damaged_gltf(user + " has " + std::to_string(binds.count) +
                       " inverse bind matrices for " + std::to_string(skin.joints.size()) +
                       " joints");
}

bool is_short(GltfNumber number) {
  return number == GltfNumber::uint8 || number == GltfNumber::uint16;
}

/// Four per vertex, of joints or of weights.
void check_influences(const GltfDocument& document, const GltfPrimitive& primitive, int index,
                      bool weights, const std::string& user) {
  const GltfAccessor& accessor = accessor_of(document, index, user);
  const bool number = weights ? accessor.number == GltfNumber::float32 ||
                                    (is_short(accessor.number) && accessor.normalized)
                              : is_short(accessor.number) && !accessor.normalized;
  if (accessor.type != "VEC4" || !number)
    throw damaged_gltf(user + " are " + accessor.type + " of component type " +
                       std::to_string(static_cast<int>(accessor.number)));
  const auto vertices = accessor_of(document, primitive.positions(), user).count;
  if (accessor.count != vertices)
    throw damaged_gltf(user + " are " + std::to_string(accessor.count) + " for " +
                       std::to_string(vertices) + " vertices");
}

void check_sets(const GltfDocument& document, const GltfPrimitive& primitive,
                const std::string& user) {
  for (const auto& [name, index] : primitive.attributes) {
    const bool joints = name.starts_with("JOINTS_"), weights = name.starts_with("WEIGHTS_");
    if (!joints && !weights) continue;
    const std::string other = (joints ? "WEIGHTS" : "JOINTS") + name.substr(name.find('_'));
    if (!primitive.attributes.contains(other))
      throw damaged_gltf(user + " has JOINTS or WEIGHTS without the other");
    check_influences(document, primitive, index, weights,
                     user + (weights ? "'s weights" : "'s joints"));
  }
}

void check_times(const GltfDocument& document, const GltfSampler& sampler,
                 const std::string& user) {
  const GltfAccessor& times = accessor_of(document, sampler.times, user + "'s times");
  if (times.type != "SCALAR" || times.number != GltfNumber::float32)
    throw damaged_gltf(user + "'s times are not SCALAR of 5126");
}

/// Rotations may be given as normalized integers.
bool is_value(const GltfAccessor& values, GltfPath path) {
  if (values.type != (path == GltfPath::rotation ? "VEC4" : "VEC3")) return false;
  if (values.number == GltfNumber::float32) return true;
  return path == GltfPath::rotation && values.normalized && values.number != GltfNumber::uint32;
}

void check_values(const GltfDocument& document, const GltfSampler& sampler, GltfPath path,
                  const std::string& user) {
  const GltfAccessor& values = accessor_of(document, sampler.values, user + "'s values");
  if (!is_value(values, path))
    throw damaged_gltf(user + "'s values are " + values.type + " of component type " +
                       std::to_string(static_cast<int>(values.number)));
  const std::int64_t times = accessor_of(document, sampler.times, user).count;
  const int each = sampler.interpolation == GltfInterpolation::cubic ? 3 : 1;
  if (values.count != each * times)
    throw damaged_gltf(user + " has " + std::to_string(values.count) + " values for " +
                       std::to_string(times) + " times");
}

void check_channel(const GltfDocument& document, const GltfAnimation& animation,
                   const GltfChannel& channel, const std::string& user) {
  check_index(channel.sampler, animation.samplers, user, "sampler");
  if (channel.node < 0 || channel.path >= GltfPath::weights) return;
  check_index(channel.node, document.nodes, user, "node");
  if (!document.nodes[static_cast<std::size_t>(channel.node)].matrix.empty())
    throw damaged_gltf(user + " moves node " + std::to_string(channel.node) +
                       ", which has a matrix");
  check_values(document, animation.samplers[static_cast<std::size_t>(channel.sampler)],
               channel.path, user);
}

void check_targets(const GltfAnimation& animation, const std::string& user) {
  std::set<std::pair<int, GltfPath>> targets;
  for (const GltfChannel& channel : animation.channels)
    if (!targets.insert({channel.node, channel.path}).second)
      throw damaged_gltf(user + " moves node " + std::to_string(channel.node) + " twice");
}

void check_animation(GltfDocument& document, GltfAnimation& animation, const std::string& user) {
  for (std::size_t i = 0; i < animation.samplers.size(); ++i)
    check_times(document, animation.samplers[i], user + '.' + nth("samplers", i));
  for (std::size_t i = 0; i < animation.channels.size(); ++i)
    check_channel(document, animation, animation.channels[i], user + '.' + nth("channels", i));
  std::erase_if(animation.channels, [&](const GltfChannel& channel) {
    document.moves_morphs = document.moves_morphs || channel.path == GltfPath::weights;
    return channel.node < 0 || channel.path >= GltfPath::weights;
  });
  check_targets(animation, user);
}

}  // namespace

void check_gltf_skins(const GltfDocument& document) {
  for (std::size_t i = 0; i < document.skins.size(); ++i) {
    check_joints(document, document.skins[i], nth("skins", i));
    check_binds(document, document.skins[i], nth("skins", i));
  }
  for_each_primitive(document, [&](const GltfPrimitive& primitive, const std::string& user) {
    if (primitive.is_surface()) check_sets(document, primitive, user);
  });
}

void check_gltf_animations(GltfDocument& document) {
  for (std::size_t i = 0; i < document.animations.size(); ++i) {
    GltfAnimation& animation = document.animations[i];
    check_animation(document, animation, nth("animations", i));
  }
}

}  // namespace sinew
