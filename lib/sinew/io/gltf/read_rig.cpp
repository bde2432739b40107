// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/read_rig.h>

#include <new>
#include <set>

#include <sinew/core/system.h>
#include <sinew/core/text.h>
#include <sinew/io/gltf/checks.h>
#include <sinew/io/gltf/joint_tracks.h>
#include <sinew/rig/skeleton.h>

namespace sinew {
namespace {

/// A small file can use the same numbers many thousand times.
void check_size(const GltfDocument& document) {
  constexpr double key = 100, node = 1000;  // bytes
  constexpr double most_visits = 1e8;       // of nodes, some 10 s
  constexpr std::size_t most_animations = 10000;
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
  if (bytes > available_memory() || visits > most_visits ||
      document.animations.size() > most_animations)
    throw bad_input("its " + std::to_string(document.animations.size()) + " animations of " +
                        std::to_string(document.nodes.size()) + " nodes hold " +
                        std::to_string(static_cast<std::int64_t>(keys)) + " keys, too many",
                    "export fewer of them");
}

const GltfNode& node_of(const GltfDocument& document, int node) {
  return document.nodes[static_cast<std::size_t>(node)];
}

/// Where the bone of a joint ends, as far as its nodes tell: at the child that is named its end,
/// or, where no joints hang on it, at its only one.
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
  return skeleton_of(joints);
}

/// Sets the clip's frames where its keys follow each other evenly.
void count_frames(const std::vector<double>& times, Clip& clip) {
  constexpr double uneven = 0.01;  // of a frame; times are in single precision
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

Clip clip_of(const GuardedGltf& gltf, const GltfBindPose& bind, const GltfTree& tree,
             std::size_t animation, double rate) {
  const GltfNodeMotion nodes = gltf_node_motion(gltf, animation);
  Clip clip;
  clip.motion = joint_motion(bind, tree, nodes, rate);
  if (!nodes.times.empty()) clip.duration = nodes.times.back();
  count_frames(nodes.times, clip);
  return clip;
}

std::vector<Clip> clips_of(const GuardedGltf& gltf, const GltfBindPose& bind, const GltfTree& tree,
                           double rate) {
  const auto& animations = gltf.document.animations;
  std::vector<Clip> clips;
  std::set<std::string> taken;
  for (std::size_t i = 0; i < animations.size(); ++i) {
    try {
      clips.push_back(clip_of(gltf, bind, tree, i, rate));
    } catch (const Error& error) {
      throw error.with_context({"animation " + std::to_string(i) + ' ' + shown(animations[i].name)});
    }
    clips.back().name = free_name(animations[i].name, i, taken);
  }
  return clips;
}

std::vector<GltfShape> skinned_shapes(const GuardedGltf& gltf, const GltfBindPose& bind) {
  std::vector<GltfShape> shapes;
  for (const int index : gltf.shown) {
    const GltfNode& node = gltf.document.nodes[static_cast<std::size_t>(index)];
    if (node.mesh >= 0 && node.skin >= 0)
      shapes.push_back({index, bind.meshes[static_cast<std::size_t>(node.skin)]});
  }
  return shapes;
}

GltfRig rig_of(const GuardedGltf& gltf, const GltfRigOptions& options) {
  if (gltf.document.skins.empty())
    throw bad_input("it has no skin", "export it with its armature and skinning");
  check_size(gltf.document);
  const GltfTree tree = gltf_tree(gltf.document);
  const GltfBindPose bind = gltf_bind_pose(gltf, tree);
  GltfRig rig;
  rig.rig.skeleton = skeleton_in(gltf.document, bind);
  rig.rig.clips = clips_of(gltf, bind, tree, options.samples_per_second);
  GltfTriangles triangles = gltf_triangles(gltf, skinned_shapes(gltf, bind));
  rig.weights = gltf_skin_weights(gltf, bind, triangles.sources);
  rig.mesh = std::move(triangles.soup);
  return rig;
}

}  // namespace

GltfRig read_gltf_rig(const std::filesystem::path& path, const GltfRigOptions& options) {
  try {
    const GuardedGltf gltf = guarded_gltf(path);
    try {
      return rig_of(gltf, options);
    } catch (const Error& error) {
      throw error.with_context({path.string()});
    }
  } catch (const std::bad_alloc&) {
    throw bad_input({path.string()}, "it takes more memory than there is",
                    "reduce its number of triangles or keys");
  }
}

bool has_skin(const std::filesystem::path& path) {
  return !guarded_gltf(path).document.skins.empty();
}

}  // namespace sinew
