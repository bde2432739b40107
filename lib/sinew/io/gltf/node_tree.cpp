// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/node_tree.h>

#include <algorithm>
#include <utility>

#include <sinew/core/decompositions.h>
#include <sinew/core/text.h>
#include <sinew/io/gltf/detail/accessors.h>

namespace sinew {
namespace {

constexpr int longest_chain = 1000;    // the longest chains have about 200
constexpr double uneven_scale = 0.01;  // far above single precision and exporters' rounding
constexpr double flat = 1e-6;          // ratio of scales of what cannot be inverted
constexpr double apart = 0.001;        // fraction of the skeleton's size, and of a scale

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

/// Whether a mesh that is shown has a skin.
bool shows_skins(const CheckedGltf& gltf) {
  return std::any_of(gltf.shown.begin(), gltf.shown.end(), [&](int index) {
    const GltfNode& node = gltf.document.nodes[static_cast<std::size_t>(index)];
    return node.mesh >= 0 && node.skin >= 0;
  });
}

std::vector<bool> skins_in_use(const CheckedGltf& gltf) {
  std::vector<bool> used(gltf.document.skins.size(), !shows_skins(gltf));
  for (const int index : gltf.shown) {
    const GltfNode& node = gltf.document.nodes[static_cast<std::size_t>(index)];
    if (node.mesh >= 0 && node.skin >= 0) used[static_cast<std::size_t>(node.skin)] = true;
  }
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

bool is_flat(const Affine& place) {
  if (!place.matrix().allFinite()) return true;
  const Vec3 scales = singular_values(place.linear()).values;
  return !(scales[2] > flat * scales[0]);
}

std::vector<Affine> resting_places(const CheckedGltf& gltf) {
  std::vector<Affine> local;
  for (const GltfNode& node : gltf.document.nodes) local.push_back(place_of(node).affine());
  return global_places(gltf.tree, local);
}

/// For each node, whether an animation moves it.
std::vector<bool> moved_nodes(const GltfDocument& document) {
  std::vector<bool> moved(document.nodes.size());
  for (const GltfAnimation& animation : document.animations)
    for (const GltfChannel& channel : animation.channels)
      moved[static_cast<std::size_t>(channel.node)] = true;
  return moved;
}

/// Adds the animated nodes that hold meshes without a skin: the nearest one above each, and in a
/// file without skins all above. A file without meshes has its animated nodes.
void add_animated(const CheckedGltf& gltf, const std::vector<bool>& animated,
                  std::vector<bool>& bones) {
  const bool skinned = shows_skins(gltf);
  bool meshes = false, held = false;
  int loose = -1;  // the topmost node above a mesh that nothing moves
  for (const int index : gltf.shown) {
    const GltfNode& node = gltf.document.nodes[static_cast<std::size_t>(index)];
    meshes = meshes || node.mesh >= 0;
    if (node.mesh < 0 || node.skin >= 0) continue;
    int top = index;
    bool moves = false;
    for (int at = index; at >= 0; at = gltf.tree.parents[static_cast<std::size_t>(at)]) {
      top = at;
      if (!animated[static_cast<std::size_t>(at)]) continue;
      bones[static_cast<std::size_t>(at)] = moves = held = true;
      if (skinned) break;
    }
    if (!moves && loose < 0) loose = top;
  }
  if (!skinned && held && loose >= 0) bones[static_cast<std::size_t>(loose)] = true;
  if (gltf.document.skins.empty() && !meshes) bones = animated;
}

/// The nodes that are bones.
std::vector<bool> bone_nodes(const CheckedGltf& gltf, const std::vector<Affine>& global) {
  const GltfDocument& document = gltf.document;
  const std::vector<bool> used = skins_in_use(gltf);
  std::vector<bool> bones(document.nodes.size());
  for (std::size_t i = 0; i < used.size(); ++i)
    for (const int node : used[i] ? document.skins[i].joints : std::vector<int>())
      bones[static_cast<std::size_t>(node)] = true;
  if (std::find(used.begin(), used.end(), true) == used.end())  // an avatar of rigid parts
    for (const int node : document.humanoid)
      if (node >= 0 && node < static_cast<int>(bones.size()) &&
          !is_flat(global[static_cast<std::size_t>(node)]))
        bones[static_cast<std::size_t>(node)] = true;
  std::vector<bool> animated = moved_nodes(document);
  for (std::size_t i = 0; i < bones.size(); ++i)
    animated[i] = bones[i] || (animated[i] && !is_flat(global[i]));
  add_animated(gltf, animated, bones);
  return bones;
}

/// The bones with the nearest one above each; `holders`: the nearest one at or above each node.
std::vector<GltfJoint> joints_of(const GltfTree& tree, const std::vector<bool>& bones,
                                 std::vector<int>& holders) {
  holders.assign(bones.size(), -1);
  std::vector<GltfJoint> joints;
  for (const int node : tree.order) {
    const auto at = static_cast<std::size_t>(node);
    const int above = tree.parents[at];
    holders[at] = above < 0 ? -1 : holders[static_cast<std::size_t>(above)];
    if (!bones[at]) continue;
    joints.push_back({node, holders[at], Affine::Identity()});
    holders[at] = static_cast<int>(joints.size()) - 1;
  }
  return joints;
}

Error not_invertible(const GltfDocument& document, int node) {
  return damaged_gltf(joint_words(document, node) + " has a bind matrix that cannot be inverted");
}

/// The smallest scale of a joint over its largest.
double evenness_of(const GltfDocument& document, const GltfJoint& joint) {
  if (is_flat(joint.bind)) throw not_invertible(document, joint.node);
  const Vec3 scales = singular_values(joint.bind.linear()).values;
  return scales[2] / scales[0];
}

bool are_one(const std::vector<Affine>& all) {
  return all.size() > 1 && std::all_of(all.begin(), all.end(), [&](const Affine& one) {
           return one.matrix() == all[0].matrix();
         });
}

/// Whether a transform moves places within a length by more than is told apart.
bool moves(const Affine& transform, const Vec3& place, double length) {
  return !((transform.linear() - Mat3::Identity()).norm() <= apart &&
           (transform * place - place).norm() <= apart * length + 1e-9 * place.norm());
}

/// Places the skins in the scene one by one.
class Binder {
 public:
  explicit Binder(const CheckedGltf& gltf)
      : document_(gltf.document), global_(resting_places(gltf)), skinned_(shows_skins(gltf)) {
    const std::vector<bool> used = skins_in_use(gltf);
    pose_.joints = joints_of(gltf.tree, bone_nodes(gltf, global_), pose_.holders);
    pose_.meshes.assign(used.size(), Affine::Identity());
    pose_.carried.resize(used.size());
    pose_.places.resize(used.size());
    bound_.assign(pose_.joints.size(), false);
    for (std::size_t i = 0; i < used.size(); ++i)
      if (used[i]) bind(gltf, i);
    place_nodes(gltf);
    warn_of_scale();
  }

  GltfBindPose pose() const { return pose_; }

 private:
  /// The topmost joint of a skin that scales its mesh as most joints do at rest.
  std::size_t top_of(const std::vector<int>& places, const std::vector<Affine>& inverses) const {
    constexpr double similar = 1.5;
    std::vector<double> scales;
    for (std::size_t i = 0; i < places.size(); ++i)
      scales.push_back(
          std::cbrt(std::abs((resting(places[i]) * inverses[i]).linear().determinant())));
    std::vector<double> sorted = scales;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    std::size_t top = 0, any = 0;
    bool found = false;
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (places[i] < places[any]) any = i;
      if (!(scales[i] < similar * *middle && scales[i] * similar > *middle)) continue;
      if (!found || places[i] < places[top]) top = i;
      found = true;
    }
    return found ? top : any;
  }

  /// Places a skin by its first joint, from `top` on, that another skin has already bound, else by
  /// `top`.
  Affine place_of_skin(const std::vector<int>& places, const std::vector<Affine>& inverses,
                       std::size_t top) const {
    for (std::size_t i = 0; i < places.size(); ++i)
      if (bound_[static_cast<std::size_t>(places[i])] && places[i] >= places[top])
        return joint(places[i]).bind * inverses[i];
    return resting(places[top]) * inverses[top];
  }

  void bind(const CheckedGltf& gltf, std::size_t skin) {
    const std::vector<Affine> inverses = inverse_binds(gltf, skin);
    std::vector<int>& places = pose_.places[skin];
    for (const int node : document_.skins[skin].joints)
      places.push_back(pose_.holders[static_cast<std::size_t>(node)]);
    const std::size_t top = top_of(places, inverses);
    pose_.meshes[skin] = place_of_skin(places, inverses, top);
    const bool unbound = are_one(inverses);
    Box box;
    for (std::size_t i = 0; i < inverses.size(); ++i) {
      if (inverses[i].linear().determinant() == 0)
        throw not_invertible(document_, document_.skins[skin].joints[i]);
      put(places[i], unbound || places[i] < places[top]
                         ? resting(places[i])
                         : pose_.meshes[skin] * inverses[i].inverse());
      box.extend(joint(places[i]).bind.translation());
    }
    carry(skin, inverses, box.diagonal().norm());
  }

  void put(int place, const Affine& bind) {
    const auto at = static_cast<std::size_t>(place);
    if (bound_[at]) return;
    bound_[at] = true;
    pose_.joints[at].bind = bind;
    const double evenness = evenness_of(document_, pose_.joints[at]);
    if (evenness < min_evenness_) min_evenness_ = evenness, uneven_joint_ = place;
    uneven_ += evenness < 1 - uneven_scale;
  }

  /// Vertices follow the joints of their own where these are bound otherwise than this skin says.
  void carry(std::size_t skin, const std::vector<Affine>& inverses, double size) {
    const Affine back = pose_.meshes[skin].inverse();
    std::vector<Affine> carried;
    bool blends = false;
    for (std::size_t i = 0; i < inverses.size(); ++i) {
      const Affine& bind = joint(pose_.places[skin][i]).bind;
      carried.push_back(bind * inverses[i]);
      blends = blends || moves(carried.back() * back, bind.translation(), size);
    }
    if (blends) pose_.carried[skin] = std::move(carried);
  }

  /// All nodes, parents first, and the bones among them that no skin binds.
  void place_nodes(const CheckedGltf& gltf) {
    pose_.nodes = global_;
    for (std::size_t i = 0; i < pose_.joints.size(); ++i)
      if (!bound_[i])
        put(static_cast<int>(i),
            below(joint(static_cast<int>(i)).parent, joint(static_cast<int>(i)).node));
    for (std::size_t node = 0; node < global_.size(); ++node)
      pose_.nodes[node] = below(pose_.holders[node], static_cast<int>(node));
    if (!skinned_) hold_the_rest(gltf);
  }

  /// Gives meshes that nothing moves to the last topmost bone that nothing moves and that holds a
  /// mesh, if there is one: joints of a skin without a mesh, beside meshes, hold none.
  void hold_the_rest(const CheckedGltf& gltf) {
    const std::vector<bool> animated = moved_nodes(document_);
    int still = -1;
    for (const int node : gltf.shown) {
      const int holder = pose_.holders[static_cast<std::size_t>(node)];
      if (document_.nodes[static_cast<std::size_t>(node)].mesh >= 0 && holder > still &&
          joint(holder).parent < 0 && !animated[static_cast<std::size_t>(joint(holder).node)])
        still = holder;
    }
    std::replace(pose_.holders.begin(), pose_.holders.end(), -1, still);
  }

  /// A node at rest, as it is where the joint above it is bound.
  Affine below(int above, int node) const {
    const Affine& place = global_[static_cast<std::size_t>(node)];
    return above < 0 || is_flat(resting(above))
               ? place
               : joint(above).bind * (resting(above).inverse() * place);
  }

  void warn_of_scale() {
    if (uneven_ == 0) return;
    pose_.warning = std::to_string(uneven_) + " of " + std::to_string(pose_.joints.size()) +
                    " joints are bound with uneven scale, " +
                    joint_words(document_, joint(uneven_joint_).node) + " by " +
                    three_digits(100 * (1 / min_evenness_ - 1)) +
                    " %: bones are rigid, and turn without it";
  }

  const Affine& resting(int place) const {
    return global_[static_cast<std::size_t>(joint(place).node)];
  }
  const GltfJoint& joint(int place) const { return pose_.joints[static_cast<std::size_t>(place)]; }

  const GltfDocument& document_;
  std::vector<Affine> global_;
  bool skinned_;             // whether meshes have skins
  std::vector<bool> bound_;  // whether a skin has bound each joint
  std::size_t uneven_ = 0;   // joints
  double min_evenness_ = 1;
  int uneven_joint_ = -1;
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

bool has_bones(const CheckedGltf& gltf) {
  const std::vector<bool> bones = bone_nodes(gltf, resting_places(gltf));
  return std::find(bones.begin(), bones.end(), true) != bones.end();
}

std::string joint_words(const GltfDocument& document, int node) {
  return "joint " + shown(document.nodes[static_cast<std::size_t>(node)].name) + " (node " +
         std::to_string(node) + ")";
}

}  // namespace sinew
