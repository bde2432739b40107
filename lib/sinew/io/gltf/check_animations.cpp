// SPDX-License-Identifier: GPL-3.0-or-later
#include <set>
#include <utility>

#include <sinew/io/gltf/checks.h>

namespace sinew {
namespace {

void check_times(const GltfDocument& document, const GltfSampler& sampler,
                 const std::string& user) {
  const GltfAccessor& times = accessor_of(document, sampler.times, user + "'s times");
  if (times.type != "SCALAR" || times.number != GltfNumber::float32)
    throw damaged_gltf(user + "'s times are not SCALAR of 5126");
}

/// Rotations may be given in parts of the largest whole number.
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
  if (channel.node < 0 || channel.path == GltfPath::other) return;
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

void check_animation(const GltfDocument& document, GltfAnimation& animation,
                     const std::string& user) {
  for (std::size_t i = 0; i < animation.samplers.size(); ++i)
    check_times(document, animation.samplers[i], user + '.' + nth("samplers", i));
  for (std::size_t i = 0; i < animation.channels.size(); ++i)
    check_channel(document, animation, animation.channels[i], user + '.' + nth("channels", i));
  std::erase_if(animation.channels, [](const GltfChannel& channel) {
    return channel.node < 0 || channel.path == GltfPath::other;
  });
  check_targets(animation, user);
}

}  // namespace

void check_gltf_animations(GltfDocument& document) {
  for (std::size_t i = 0; i < document.animations.size(); ++i) {
    GltfAnimation& animation = document.animations[i];
    check_animation(document, animation, nth("animations", i));
  }
}

}  // namespace sinew
