// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/detail/weights.h>

#include <algorithm>
#include <string>

#include <sinew/core/text.h>
#include <sinew/io/gltf/detail/accessors.h>

namespace sinew {
namespace {

constexpr int max_sets = 8;  // exporters write one or two

void check_set(const std::vector<double>& joints, const std::vector<double>& weights,
               std::size_t count, const std::string& user) {
  for (const double joint : joints)
    if (joint >= static_cast<double>(count))
      throw damaged_gltf(user + " names joint " + std::to_string(static_cast<int>(joint)) + " of " +
                         std::to_string(count));
  for (const double weight : weights)
    if (weight < 0) throw damaged_gltf(user + " has the weight " + std::to_string(weight));
}

/// Initialized to 0 where it is new.
double& weight_of(int bone, std::vector<BoneWeight>& weights) {
  for (BoneWeight& weight : weights)
    if (weight.bone == bone) return weight.weight;
  weights.push_back({bone, 0});
  return weights.back().weight;
}

}  // namespace

GltfWeights::GltfWeights(const CheckedGltf& gltf, std::size_t mesh_index, std::size_t primitive,
                         std::size_t joints) {
  const GltfMesh& mesh = gltf.document.meshes[mesh_index];
  const auto& attributes = mesh.primitives[primitive].attributes;
  const std::string user = "mesh " + std::to_string(mesh_index) + ' ' + shown(mesh.name);
  for (int i = 0; i < max_sets; ++i) {
    const auto found = attributes.find("JOINTS_" + std::to_string(i));
    if (found == attributes.end()) break;
    const int weights = attributes.at("WEIGHTS_" + std::to_string(i));
    sets_.push_back({gltf_values(gltf, found->second, user + "'s joints"),
                     gltf_values(gltf, weights, user + "'s weights")});
    check_set(sets_.back().joints, sets_.back().weights, joints, user);
  }
  if (sets_.empty())
    throw bad_input(user + " has a skin but no weights", "bind all of it to the skeleton");
}

std::vector<BoneWeight> GltfWeights::of(std::size_t vertex, const std::vector<int>& bones) const {
  std::vector<BoneWeight> weights;
  double sum = 0;
  for (const Set& set : sets_)
    for (std::size_t i = 4 * vertex; i < 4 * vertex + 4; ++i) {
      if (set.weights[i] == 0) continue;
      const int bone = bones[static_cast<std::size_t>(set.joints[i])];
      weight_of(bone, weights) += set.weights[i];
      sum += set.weights[i];
    }
  for (BoneWeight& weight : weights) weight.weight /= sum;
  std::stable_sort(weights.begin(), weights.end(), [](const BoneWeight& a, const BoneWeight& b) {
    return a.weight != b.weight ? a.weight > b.weight : a.bone < b.bone;
  });
  return weights;
}

}  // namespace sinew
