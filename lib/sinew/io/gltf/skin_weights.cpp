// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/skin_weights.h>

#include <algorithm>

#include <sinew/core/text.h>
#include <sinew/io/gltf/checks.h>
#include <sinew/io/gltf/values.h>

namespace sinew {
namespace {

constexpr int most_sets = 8;  // exporters write one or two

/// Four joints and four weights for each vertex of a primitive.
struct Set {
  std::vector<double> joints, weights;
};

void check_set(const Set& set, std::size_t joints, const std::string& user) {
  for (const double joint : set.joints)
    if (joint >= static_cast<double>(joints))
      throw damaged_gltf(user + " names joint " + std::to_string(static_cast<int>(joint)) + " of " +
                         std::to_string(joints));
  for (const double weight : set.weights)
    if (weight < 0) throw damaged_gltf(user + " has the weight " + std::to_string(weight));
}

std::vector<Set> sets_of(const GuardedGltf& gltf, const GltfPrimitive& primitive,
                         std::size_t joints, const std::string& user) {
  std::vector<Set> sets;
  for (int i = 0; i < most_sets; ++i) {
    const auto found = primitive.attributes.find("JOINTS_" + std::to_string(i));
    if (found == primitive.attributes.end()) break;
    const int weights = primitive.attributes.at("WEIGHTS_" + std::to_string(i));
    sets.push_back({gltf_values(gltf, found->second, user + "'s joints"),
                    gltf_values(gltf, weights, user + "'s weights")});
    check_set(sets.back(), joints, user);
  }
  if (sets.empty())
    throw bad_input(user + " has a skin but no weights", "bind all of it to the skeleton");
  return sets;
}

/// A new one is 0.
double& weight_of(int bone, std::vector<BoneWeight>& weights) {
  for (BoneWeight& weight : weights)
    if (weight.bone == bone) return weight.weight;
  weights.push_back({bone, 0});
  return weights.back().weight;
}

/// Each bone once, normalized.
std::vector<BoneWeight> weights_of(const std::vector<Set>& sets, const std::vector<int>& places,
                                   std::size_t vertex) {
  std::vector<BoneWeight> weights;
  double sum = 0;
  for (const Set& set : sets)
    for (std::size_t i = 4 * vertex; i < 4 * vertex + 4; ++i) {
      if (set.weights[i] == 0) continue;
      const int bone = places[static_cast<std::size_t>(set.joints[i])];
      weight_of(bone, weights) += set.weights[i];
      sum += set.weights[i];
    }
  for (BoneWeight& weight : weights) weight.weight /= sum;
  std::stable_sort(weights.begin(), weights.end(), [](const BoneWeight& a, const BoneWeight& b) {
    return a.weight != b.weight ? a.weight > b.weight : a.bone < b.bone;
  });
  return weights;
}

bool same_primitive(const GltfVertex& a, const GltfVertex& b) {
  return a.node == b.node && a.primitive == b.primitive;
}

}  // namespace

SkinWeights gltf_skin_weights(const GuardedGltf& gltf, const GltfBindPose& bind,
                              const std::vector<GltfVertex>& vertices) {
  SkinWeights all{{0}, {}};
  std::vector<Set> sets;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const GltfNode& node = gltf.document.nodes[static_cast<std::size_t>(vertices[i].node)];
    const auto mesh = static_cast<std::size_t>(node.mesh),
               skin = static_cast<std::size_t>(node.skin);
    const auto primitive = static_cast<std::size_t>(vertices[i].primitive);
    if (i == 0 || !same_primitive(vertices[i - 1], vertices[i]))
      sets = sets_of(gltf, gltf.document.meshes[mesh].primitives[primitive],
                     gltf.document.skins[skin].joints.size(),
                     "mesh " + std::to_string(mesh) + ' ' + shown(gltf.document.meshes[mesh].name));
    const auto weights =
        weights_of(sets, bind.places[skin], static_cast<std::size_t>(vertices[i].vertex));
    all.weights.insert(all.weights.end(), weights.begin(), weights.end());
    all.first.push_back(static_cast<std::uint32_t>(all.weights.size()));
  }
  return all;
}

}  // namespace sinew
