// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/rig.h>

#include <algorithm>
#include <map>
#include <new>
#include <optional>

#include <sinew/core/text.h>
#include <sinew/io/gltf/detail/clips.h>
#include <sinew/io/gltf/detail/weights.h>
#include <sinew/io/gltf/geometry.h>
#include <sinew/rig/skeleton.h>

namespace sinew {
namespace {

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

/// Ends of bones without a skin, whose nodes show none: opposite their heads in what they carry. A
/// single bone carries all.
std::vector<std::optional<Vec3>> ends_of_rigid(const GltfBindPose& bind,
                                               const std::vector<GltfShape>& shapes,
                                               const GltfTriangles& triangles) {
  std::map<int, int> joint_of_node;
  for (const GltfShape& shape : shapes) joint_of_node[shape.node] = shape.joint;
  std::vector<Box> boxes(bind.joints.size());
  const bool single = boxes.size() == 1;
  for (std::size_t i = 0; i < triangles.sources.size(); ++i)
    if (const int joint = single ? 0 : joint_of_node[triangles.sources[i].node]; joint >= 0)
      boxes[static_cast<std::size_t>(joint)].extend(triangles.soup.points[i]);
  for (const std::vector<int>& places : bind.places)
    for (const int joint : single ? std::vector<int>() : places)
      boxes[static_cast<std::size_t>(joint)] = Box();
  std::vector<std::optional<Vec3>> ends(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (boxes[i].isEmpty()) continue;
    const Vec3 head = bind.joints[i].bind.translation(), way = 2 * (boxes[i].center() - head);
    const double size = boxes[i].diagonal().norm();
    ends[i] = head + (way.norm() > 0.1 * size ? way : Vec3(0, size / 2, 0));
  }
  return ends;
}

Skeleton skeleton_in(const GltfDocument& document, const GltfBindPose& bind,
                     const std::vector<std::optional<Vec3>>& rigid) {
  std::vector<bool> leaf(bind.joints.size(), true);
  for (const GltfJoint& joint : bind.joints)
    if (joint.parent >= 0) leaf[static_cast<std::size_t>(joint.parent)] = false;
  std::vector<Joint> joints;
  for (const GltfJoint& joint : bind.joints) {
    std::optional<Vec3> end = end_of(document, joint, leaf[joints.size()]);
    if (!end && leaf[joints.size()]) end = rigid[joints.size()];
    joints.push_back(
        {node_of(document, joint.node).name, joint.parent, joint.bind.translation(), end});
  }
  return skeleton_of(joints,
                     "give their nodes different places, or one of them a child as its end");
}

bool same_primitive(const GltfVertex& a, const GltfVertex& b) {
  return a.node == b.node && a.primitive == b.primitive;
}

BoneWeights skin_weights(const CheckedGltf& gltf, const GltfBindPose& bind,
                         const std::vector<GltfVertex>& vertices) {
  BoneWeights all{{0}, {}};
  std::optional<GltfWeights> sets;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const GltfNode& node = node_of(gltf.document, vertices[i].node);
    const auto mesh = static_cast<std::size_t>(node.mesh),
               skin = static_cast<std::size_t>(node.skin);
    std::vector<BoneWeight> weights;
    if (node.skin < 0) {
      weights = {{bind.holders[static_cast<std::size_t>(vertices[i].node)], 1}};
    } else {
      if (i == 0 || !same_primitive(vertices[i - 1], vertices[i]))
        sets.emplace(gltf, mesh, static_cast<std::size_t>(vertices[i].primitive),
                     gltf.document.skins[skin].joints.size());
      weights = sets->of(static_cast<std::size_t>(vertices[i].vertex), bind.places[skin]);
    }
    all.weights.insert(all.weights.end(), weights.begin(), weights.end());
    all.first.push_back(static_cast<std::uint32_t>(all.weights.size()));
  }
  return all;
}

/// Shapes that follow bones.
std::vector<GltfShape> bound_shapes(const CheckedGltf& gltf, const GltfBindPose& bind,
                                    std::vector<std::string>& warnings) {
  std::vector<GltfShape> shapes = gltf_shapes(gltf, bind);
  const std::size_t loose = std::erase_if(shapes, [&](const GltfShape& shape) {
    return node_of(gltf.document, shape.node).skin < 0 && shape.joint < 0;
  });
  if (loose > 0)
    warnings.push_back(std::to_string(loose) + (loose == 1 ? " mesh has" : " meshes have") +
                       " neither skin nor joint above, and follow the nearest bones");
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
  if (!has_bones(gltf))
    throw bad_input("it has no skin and no animated nodes",
                    "export it with its armature and skinning");
  const GltfBindPose bind = gltf_bind_pose(gltf);
  SkinnedRig rig;
  if (!bind.warning.empty()) rig.rig.warnings.push_back(bind.warning);
  const std::vector<GltfShape> shapes = bound_shapes(gltf, bind, rig.rig.warnings);
  GltfTriangles triangles = gltf_triangles(gltf, shapes);
  rig.rig.skeleton = skeleton_in(gltf.document, bind, ends_of_rigid(bind, shapes, triangles));
  rig.rig.clips = gltf_clips(gltf, bind, options.samples_per_second);
  rig.weights = skin_weights(gltf, bind, triangles.sources);
  rig.mesh = std::move(triangles.soup);
  warn_of_weightless(rig);
  return rig;
}

/// Runs with the path in errors.
template <class Make>
auto of_file(const std::filesystem::path& path, const Make& make) {
  try {
    return make();
  } catch (const Error& error) {
    throw error.with_context({path.string()});
  } catch (const std::bad_alloc&) {
    throw bad_input({path.string()}, "it takes more memory than there is",
                    "reduce its number of triangles or keys");
  }
}

CheckedGltf animated_gltf(const std::filesystem::path& path) {
  CheckedGltf gltf = checked_gltf(path);
  join_unnamed(gltf);
  return gltf;
}

void name_file(const std::filesystem::path& path, std::vector<std::string>& warnings) {
  for (std::string& warning : warnings) warning.insert(0, Place{path.string()}.text() + ": ");
}

}  // namespace

SkinnedRig read_gltf_rig(const std::filesystem::path& path, const GltfRigOptions& options) {
  const CheckedGltf gltf = animated_gltf(path);
  SkinnedRig rig = of_file(path, [&] { return rig_in(gltf, options); });
  name_file(path, rig.rig.warnings);
  return rig;
}

Rig read_gltf_clips(const std::filesystem::path& skeleton, const std::filesystem::path& clips,
                    const GltfRigOptions& options) {
  const CheckedGltf gltf = checked_gltf(skeleton), from = animated_gltf(clips);
  const GltfBindPose bind = of_file(skeleton, [&] { return gltf_bind_pose(gltf); });
  Rig rig;
  rig.skeleton = read_gltf_rig(skeleton, options).rig.skeleton;
  rig.clips = of_file(clips, [&] {
    return gltf_clips_from(from, gltf, bind, options.samples_per_second, rig.warnings);
  });
  name_file(clips, rig.warnings);
  return rig;
}

bool has_gltf_rig(const std::filesystem::path& path) { return has_bones(checked_gltf(path)); }

}  // namespace sinew
