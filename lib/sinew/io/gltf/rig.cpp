// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/rig.h>

#include <algorithm>
#include <new>
#include <optional>
#include <set>

#include <sinew/core/system.h>
#include <sinew/core/text.h>
#include <sinew/io/gltf/detail/accessors.h>
#include <sinew/io/gltf/detail/joint_motion.h>
#include <sinew/io/gltf/geometry.h>
#include <sinew/rig/skeleton.h>

namespace sinew {
namespace {

constexpr int max_sets = 8;  // exporters write one or two

/// A small file can refer to the same numbers many thousand times.
void check_size(const GltfDocument& document) {
  constexpr double key = 100, node = 1000;  // bytes
  constexpr double max_visits = 1e8;        // visits of nodes, about 10 s
  constexpr std::size_t max_animations = 10000;
  double bytes = node * static_cast<double>(document.nodes.size()), keys = 0;
  for (const GltfAnimation& animation : document.animations)
    for (const GltfChannel& channel : animation.channels) {
      const GltfSampler& sampler = animation.samplers[static_cast<std::size_t>(channel.sampler)];
      keys +=
          static_cast<double>(document.accessors[static_cast<std::size_t>(sampler.values)].count);
    }
  bytes += key * keys;
  const double visits =
      static_cast<double>(document.nodes.size()) * static_cast<double>(document.animations.size());
  if (bytes > available_memory() || visits > max_visits ||
      document.animations.size() > max_animations)
    throw bad_input("its " + std::to_string(document.animations.size()) + " animations of " +
                        std::to_string(document.nodes.size()) + " nodes hold " +
                        std::to_string(static_cast<std::int64_t>(keys)) + " keys, too many",
                    "export fewer of them");
}

const GltfNode& node_of(const GltfDocument& document, int node) {
  return document.nodes[static_cast<std::size_t>(node)];
}

/// The end of a joint's bone by its nodes: at the child named as its end, or, where it has no child
/// joints, at its only child.
std::optional<Vec3> end_of(const GltfDocument& document, const GltfJoint& joint, bool is_leaf) {
  const GltfNode& node = node_of(document, joint.node);
  std::string end = node.name;
  end += "_end";
  for (const int child : node.children)
    if (!node.name.empty() && node_of(document, child).name == end)
      return joint.bind * place_of(node_of(document, child)).translation;
  if (!is_leaf || node.children.size() != 1) return std::nullopt;
  const GltfNode& child = node_of(document, node.children[0]);
  if (child.mesh >= 0) return std::nullopt;
  return joint.bind * place_of(child).translation;
}

Skeleton skeleton_in(const GltfDocument& document, const GltfBindPose& bind) {
  std::vector<bool> leaf(bind.joints.size(), true);
  for (const GltfJoint& joint : bind.joints)
    if (joint.parent >= 0) leaf[static_cast<std::size_t>(joint.parent)] = false;
  std::vector<Joint> joints;
  for (const GltfJoint& joint : bind.joints)
    joints.push_back({node_of(document, joint.node).name, joint.parent, joint.bind.translation(),
                      end_of(document, joint, leaf[joints.size()])});
  return skeleton_of(joints,
                     "give their nodes different places, or one of them a child as its end");
}

/// Sets the clip's frames where its keys are evenly spaced.
void count_frames(const std::vector<double>& times, Clip& clip) {
  constexpr double uneven = 0.01;  // fraction of a frame; times are in single precision
  if (times.size() < 2) return;
  const double first = times.front(), count = static_cast<double>(times.size());
  const double frame = (times.back() - first) / (count - 1);
  for (std::size_t i = 0; i < times.size(); ++i)
    if (std::abs(times[i] - first - frame * static_cast<double>(i)) > uneven * frame) return;
  clip.frames = static_cast<int>(times.size());
  clip.frame_time = frame;
}

std::string free_name(const std::string& name, std::size_t index, std::set<std::string>& taken) {
  const std::string wanted = name.empty() ? "animation_" + std::to_string(index) : name;
  std::string free = wanted;
  for (int i = 2; !taken.insert(free).second; ++i) {
    free = wanted;
    free += '_' + std::to_string(i);
  }
  return free;
}

Clip clip_of(const CheckedGltf& gltf, const GltfBindPose& bind, std::size_t animation,
             double rate) {
  const GltfNodeMotion nodes = gltf_node_motion(gltf, animation);
  Clip clip;
  clip.motion = joint_motion(bind, gltf.tree, nodes, rate);
  if (!nodes.times.empty()) clip.duration = nodes.times.back() - nodes.times.front();
  count_frames(nodes.times, clip);
  return clip;
}

std::vector<Clip> clips_of(const CheckedGltf& gltf, const GltfBindPose& bind, double rate) {
  const auto& animations = gltf.document.animations;
  std::vector<Clip> clips;
  std::set<std::string> taken;
  for (std::size_t i = 0; i < animations.size(); ++i) {
    try {
      clips.push_back(clip_of(gltf, bind, i, rate));
    } catch (const Error& error) {
      throw error.with_context(
          {"animation " + std::to_string(i) + ' ' + shown(animations[i].name)});
    }
    clips.back().name = free_name(animations[i].name, i, taken);
  }
  return clips;
}

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

std::vector<Set> sets_of(const CheckedGltf& gltf, const GltfPrimitive& primitive,
                         std::size_t joints, const std::string& user) {
  std::vector<Set> sets;
  for (int i = 0; i < max_sets; ++i) {
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

/// Initialized to 0 where it is new.
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

BoneWeights skin_weights(const CheckedGltf& gltf, const GltfBindPose& bind,
                         const std::vector<GltfVertex>& vertices) {
  BoneWeights all{{0}, {}};
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

std::vector<GltfShape> skinned_shapes(const CheckedGltf& gltf, const GltfBindPose& bind) {
  std::vector<GltfShape> shapes;
  for (const int index : gltf.shown) {
    const GltfNode& node = gltf.document.nodes[static_cast<std::size_t>(index)];
    if (node.mesh >= 0 && node.skin >= 0)
      shapes.push_back({index, bind.meshes[static_cast<std::size_t>(node.skin)]});
  }
  return shapes;
}

void warn_of_weightless(SkinnedRig& rig) {
  const std::size_t all = rig.mesh.points.size();
  std::size_t weightless = 0;
  for (std::size_t i = 0; i < all; ++i) weightless += rig.weights.of(i).empty();
  if (weightless > 0)
    rig.rig.warnings.push_back(std::to_string(weightless) + " of " + std::to_string(all) +
                               " vertices of its skin have no weights above 0, and follow no bone");
}

SkinnedRig rig_in(const CheckedGltf& gltf, const GltfRigOptions& options) {
  if (gltf.document.skins.empty())
    throw bad_input("it has no skin", "export it with its armature and skinning");
  check_size(gltf.document);
  const GltfBindPose bind = gltf_bind_pose(gltf);
  SkinnedRig rig;
  rig.rig.skeleton = skeleton_in(gltf.document, bind);
  rig.rig.clips = clips_of(gltf, bind, options.samples_per_second);
  GltfTriangles triangles = gltf_triangles(gltf, skinned_shapes(gltf, bind));
  rig.weights = skin_weights(gltf, bind, triangles.sources);
  rig.mesh = std::move(triangles.soup);
  warn_of_weightless(rig);
  return rig;
}

}  // namespace

SkinnedRig read_gltf_rig(const std::filesystem::path& path, const GltfRigOptions& options) {
  try {
    const CheckedGltf gltf = checked_gltf(path);
    try {
      SkinnedRig rig = rig_in(gltf, options);
      for (std::string& warning : rig.rig.warnings)
        warning.insert(0, Place{path.string()}.text() + ": ");
      return rig;
    } catch (const Error& error) {
      throw error.with_context({path.string()});
    }
  } catch (const std::bad_alloc&) {
    throw bad_input({path.string()}, "it takes more memory than there is",
                    "reduce its number of triangles or keys");
  }
}

bool has_skin(const std::filesystem::path& path) {
  return !checked_gltf(path).document.skins.empty();
}

}  // namespace sinew
