// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/node_tree.h>

#include <algorithm>
#include <optional>

#include <sinew/core/decompositions.h>
#include <sinew/core/text.h>
#include <sinew/io/gltf/detail/accessors.h>

namespace sinew {
namespace {

constexpr int longest_chain = 1000;    // the longest chains have about 200
constexpr double uneven_scale = 0.01;  // far above single precision and exporters' rounding
constexpr double apart = 0.001;        // fraction of the skeleton's size

/// Each node's parent, -1 for none.
std::vector<int> parents_of(const GltfDocument& document) {
  std::vector<int> parents(document.nodes.size(), -1);
  for (std::size_t i = 0; i < document.nodes.size(); ++i)
    for (const int child : document.nodes[i].children) {
      check_index(child, document.nodes, nth("nodes", i), "child");
      int& parent = parents[static_cast<std::size_t>(child)];
      if (parent >= 0) throw damaged_gltf("node " + std::to_string(child) + " has two parents");
      parent = static_cast<int>(i);
    }
  return parents;
}

/// Without recursion; children in the file's order. Leaves out nodes in cycles.
std::vector<int> depth_first(const GltfDocument& document, const std::vector<int>& parents) {
  std::vector<int> order, waiting;
  for (std::size_t i = parents.size(); i-- > 0;)
    if (parents[i] < 0) waiting.push_back(static_cast<int>(i));
  while (!waiting.empty()) {
    order.push_back(waiting.back());
    waiting.pop_back();
    const auto& children = document.nodes[static_cast<std::size_t>(order.back())].children;
    waiting.insert(waiting.end(), children.rbegin(), children.rend());
  }
  return order;
}

/// Nodes missing from the order are in cycles.
void check_tree(const GltfTree& tree) {
  std::vector<int> depth(tree.parents.size());
  for (const int node : tree.order) {
    const auto at = static_cast<std::size_t>(node);
    if (tree.parents[at] >= 0) depth[at] = depth[static_cast<std::size_t>(tree.parents[at])] + 1;
    if (depth[at] > longest_chain) throw damaged_gltf("its nodes are nested more than 1000 deep");
  }
  if (tree.order.size() < tree.parents.size())
    throw damaged_gltf("some of its nodes are children of themselves");
}

std::vector<bool> skins_in_use(const CheckedGltf& gltf) {
  std::vector<bool> used(gltf.document.skins.size());
  for (const int index : gltf.shown) {
    const GltfNode& node = gltf.document.nodes[static_cast<std::size_t>(index)];
    if (node.mesh >= 0 && node.skin >= 0) used[static_cast<std::size_t>(node.skin)] = true;
  }
  if (std::find(used.begin(), used.end(), true) == used.end()) used.assign(used.size(), true);
  return used;
}

/// One for each joint of a skin.
std::vector<Affine> inverse_binds(const CheckedGltf& gltf, std::size_t skin_index) {
  const GltfSkin& skin = gltf.document.skins[skin_index];
  std::vector<Affine> inverses(skin.joints.size(), Affine::Identity());
  if (skin.binds < 0) return inverses;
  const std::string user = nth("skins", skin_index) + "'s inverse bind matrices";
  const std::vector<double> values = gltf_values(gltf, skin.binds, user);
  for (std::size_t i = 0; i < inverses.size(); ++i) {
    const Eigen::Map<const Eigen::Matrix4d> matrix(values.data() + 16 * i);
    if ((matrix.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() > 1e-4)
      throw damaged_gltf(user + " do not end in the row 0 0 0 1");
    inverses[i].linear() = matrix.topLeftCorner<3, 3>();
    inverses[i].translation() = matrix.col(3).head<3>();
  }
  return inverses;
}

/// The joints of all skins in use, each with the nearest one above it.
std::vector<GltfJoint> joints_of(const GltfDocument& document, const GltfTree& tree,
                                 const std::vector<bool>& used) {
  std::vector<int> place(document.nodes.size(), -1);  // index in joints; else of the joint above
  std::vector<bool> is_joint(document.nodes.size());
  for (std::size_t i = 0; i < used.size(); ++i)
    for (const int node : used[i] ? document.skins[i].joints : std::vector<int>())
      is_joint[static_cast<std::size_t>(node)] = true;
  std::vector<GltfJoint> joints;
  for (const int node : tree.order) {
    const auto at = static_cast<std::size_t>(node);
    const int above = tree.parents[at];
    place[at] = above < 0 ? -1 : place[static_cast<std::size_t>(above)];
    if (!is_joint[at]) continue;
    joints.push_back({node, place[at], Affine::Identity()});
    place[at] = static_cast<int>(joints.size()) - 1;
  }
  return joints;
}

Error not_invertible(const GltfDocument& document, int node) {
  return damaged_gltf(joint_words(document, node) + " has a bind matrix that cannot be inverted");
}

void check_bind(const GltfDocument& document, const GltfJoint& joint) {
  const Mat3 linear = joint.bind.linear() * (joint.bind.linear().determinant() < 0 ? -1 : 1);
  if (!joint.bind.matrix().allFinite() || !(linear.determinant() > 0))
    throw not_invertible(document, joint.node);
  if (even_scale(linear, uneven_scale) > 0) return;
  const Vec3 scales = linear.colwise().norm();
  throw bad_input(joint_words(document, joint.node) + " is bound with the uneven scale " +
                      std::to_string(scales[0]) + " " + std::to_string(scales[1]) + " " +
                      std::to_string(scales[2]),
                  "apply its scale before binding");
}

/// Places the skins in the scene one by one.
class Binder {
 public:
  explicit Binder(const CheckedGltf& gltf) : document_(gltf.document) {
    std::vector<Affine> local;
    for (const GltfNode& node : document_.nodes) local.push_back(place_of(node).affine());
    global_ = global_places(gltf.tree, local);
    const std::vector<bool> used = skins_in_use(gltf);
    pose_.joints = joints_of(document_, gltf.tree, used);
    pose_.meshes.assign(used.size(), Affine::Identity());
    pose_.places.resize(used.size());
    bound_by_.assign(pose_.joints.size(), -1);
    place_of_node_.assign(document_.nodes.size(), -1);
    for (std::size_t i = 0; i < pose_.joints.size(); ++i)
      place_of_node_[static_cast<std::size_t>(pose_.joints[i].node)] = static_cast<int>(i);
    for (std::size_t i = 0; i < used.size(); ++i)
      if (used[i]) bind(gltf, i);
  }

  GltfBindPose pose() const { return pose_; }

 private:
  /// Places a skin by its first joint that another skin has already bound, else by its topmost one.
  Affine place_of_skin(const std::vector<int>& places, const std::vector<Affine>& inverses) const {
    std::size_t top = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (bound_by_[static_cast<std::size_t>(places[i])] >= 0)
        return joint(places[i]).bind * inverses[i];
      if (places[i] < places[top]) top = i;
    }
    return global_[static_cast<std::size_t>(joint(places[top]).node)] * inverses[top];
  }

  void bind(const CheckedGltf& gltf, std::size_t skin) {
    const std::vector<Affine> inverses = inverse_binds(gltf, skin);
    std::vector<int>& places = pose_.places[skin];
    for (const int node : document_.skins[skin].joints)
      places.push_back(place_of_node_[static_cast<std::size_t>(node)]);
    pose_.meshes[skin] = place_of_skin(places, inverses);
    std::vector<Affine> binds;
    Box box;
    for (std::size_t i = 0; i < inverses.size(); ++i) {
      if (inverses[i].linear().determinant() == 0)
        throw not_invertible(document_, document_.skins[skin].joints[i]);
      binds.push_back(pose_.meshes[skin] * inverses[i].inverse());
      box.extend(binds.back().translation());
    }
    for (std::size_t i = 0; i < places.size(); ++i)
      put(places[i], binds[i], static_cast<int>(skin), apart * box.diagonal().norm());
  }

  void put(int place, const Affine& bind, int skin, double most) {
    GltfJoint& joint = pose_.joints[static_cast<std::size_t>(place)];
    int& by = bound_by_[static_cast<std::size_t>(place)];
    if (by < 0) {
      joint.bind = bind;
      by = skin;
      return check_bind(document_, joint);
    }
    const double distance = (joint.bind.translation() - bind.translation()).norm();
    if (!(distance <= most + 1e-9 * bind.translation().norm()))
      throw bad_input("skins " + std::to_string(by) + " and " + std::to_string(skin) + " bind " +
                          joint_words(document_, joint.node) + " at places " +
                          std::to_string(distance) + " m apart",
                      "bind all meshes in the same pose");
  }

  const GltfJoint& joint(int place) const { return pose_.joints[static_cast<std::size_t>(place)]; }

  const GltfDocument& document_;
  std::vector<Affine> global_;
  std::vector<int> place_of_node_;  // in the list of joints, -1 for others
  std::vector<int> bound_by_;       // the first skin that binds each joint, -1 for none
  GltfBindPose pose_;
};

}  // namespace

GltfTree gltf_tree(const GltfDocument& document) {
  GltfTree tree{parents_of(document), {}};
  tree.order = depth_first(document, tree.parents);
  check_tree(tree);
  return tree;
}

Affine GltfPlace::affine() const {
  Affine affine = Affine::Identity();
  affine.translation() = translation;
  affine.linear() = whole ? linear : Mat3(rotation.toRotationMatrix() * scale.asDiagonal());
  return affine;
}

GltfPlace place_of(const GltfNode& node) {
  GltfPlace place;
  if (const auto& t = node.translation; !t.empty()) place.translation = Vec3(t.data());
  if (const auto& q = node.rotation; !q.empty()) place.rotation = Quat(q[3], q[0], q[1], q[2]);
  if (const auto& s = node.scale; !s.empty()) place.scale = Vec3(s.data());
  if (!node.matrix.empty()) {
    const Eigen::Map<const Eigen::Matrix4d> matrix(node.matrix.data());
    place.translation = matrix.col(3).head<3>();
    place.linear = matrix.topLeftCorner<3, 3>();
    place.whole = true;
  }
  return place;
}

std::vector<Affine> global_places(const GltfTree& tree, const std::vector<Affine>& local) {
  std::vector<Affine> global(local.size());
  for (const int node : tree.order) {
    const auto at = static_cast<std::size_t>(node);
    const int parent = tree.parents[at];
    global[at] = parent < 0 ? local[at] : global[static_cast<std::size_t>(parent)] * local[at];
  }
  return global;
}

double even_scale(const Mat3& matrix, double tolerance) {
  if (!matrix.allFinite() || !(matrix.determinant() > 0)) return 0;
  const Vec3 scales = singular_values(matrix).values;
  return scales[2] >= (1 - tolerance) * scales[0] ? std::cbrt(scales.prod()) : 0;
}

Mat3 nearest_rotation(const Mat3& matrix) {
  const auto [U, sizes, V] = singular_values(matrix);
  const Mat3 rotation = U * V.transpose();
  return rotation.determinant() < 0 ? Mat3(-rotation) : rotation;
}

GltfBindPose gltf_bind_pose(const CheckedGltf& gltf) { return Binder(gltf).pose(); }

std::string joint_words(const GltfDocument& document, int node) {
  return "joint " + shown(document.nodes[static_cast<std::size_t>(node)].name) + " (node " +
         std::to_string(node) + ")";
}

}  // namespace sinew
