// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/detail/joint_motion.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/decompositions.h>
#include <sinew/core/error.h>

namespace sinew {
namespace {

constexpr double unnoticed_scale = 0.05;  // exporters round, and breathing scales by less
constexpr double uneven_node = 1e-4;      // fraction of a node's scale; more is not rounding
constexpr double max_places = 2e7;        // about 10 s
constexpr double motionless = 1e-6;       // rad, and of the skeleton's size

std::size_t at(int index) { return static_cast<std::size_t>(index); }

/// The position of a joint's head at bind, and its rotation; no joint (-1) is the scene.
Vec3 bound_head(const GltfBindPose& bind, int joint) {
  return joint < 0 ? Vec3::Zero() : Vec3(bind.joints[at(joint)].bind.translation());
}

Mat3 bound_turn(const GltfBindPose& bind, int joint) {
  return joint < 0 ? Mat3::Identity() : nearest_rotation(bind.joints[at(joint)].bind.linear());
}

/// The link from a joint's parent joint (from the scene for a topmost one) to the joint.
struct GltfLink {
  Affine between = Affine::Identity();  ///< transform of the static nodes between the two
  double scale = 1;                     ///< scale of lengths, by the parent joint and all above
  bool exact =
      true;  ///< nothing between the two moves; scales are constant, even and do not mirror
};

std::vector<Affine> still_places(const GltfNodeMotion& nodes) {
  std::vector<Affine> places;
  for (const GltfPlace& place : nodes.places) places.push_back(place.affine());
  return places;
}

/// For each node, whether it and all nodes above keep an even scale.
std::vector<bool> even_nodes(const GltfTree& tree, const GltfNodeMotion& nodes) {
  std::vector<bool> even(tree.parents.size());
  for (const int node : tree.order) {
    const int above = tree.parents[at(node)];
    even[at(node)] = (above < 0 || even[at(above)]) && nodes.curves[at(node)].scale.empty() &&
                     even_scale(nodes.places[at(node)].affine().linear(), uneven_node) > 0;
  }
  return even;
}

/// For each node, the transform of the nodes between it and the nearest joint above.
std::vector<GltfLink> links_of_nodes(const GltfBindPose& bind, const GltfTree& tree,
                                     const GltfNodeMotion& nodes,
                                     const std::vector<Affine>& local) {
  std::vector<bool> is_joint(local.size());
  for (const GltfJoint& joint : bind.joints) is_joint[at(joint.node)] = true;
  std::vector<GltfLink> links(local.size());
  for (const int node : tree.order) {
    const int above = tree.parents[at(node)];
    if (above < 0 || is_joint[at(above)]) continue;
    links[at(node)].between = links[at(above)].between * local[at(above)];
    links[at(node)].exact = links[at(above)].exact && nodes.curves[at(above)].empty();
  }
  return links;
}

bool mirrors(const GltfBindPose& bind, int joint) {
  return joint >= 0 && bind.joints[at(joint)].bind.linear().determinant() < 0;
}

/// One for each joint.
std::vector<GltfLink> joint_links(const GltfBindPose& bind, const GltfTree& tree,
                                  const GltfNodeMotion& nodes) {
  const std::vector<bool> even = even_nodes(tree, nodes);
  const std::vector<Affine> local = still_places(nodes), global = global_places(tree, local);
  const std::vector<GltfLink> of_nodes = links_of_nodes(bind, tree, nodes, local);
  std::vector<GltfLink> links;
  for (std::size_t i = 0; i < bind.joints.size(); ++i) {
    const GltfJoint& joint = bind.joints[i];
    GltfLink link = of_nodes[at(joint.node)];
    link.exact = link.exact && even[at(joint.node)] && !mirrors(bind, static_cast<int>(i)) &&
                 !mirrors(bind, joint.parent);
    if (joint.parent >= 0) {
      const int above = bind.joints[at(joint.parent)].node;
      link.scale = std::cbrt(global[at(above)].linear().determinant());
    }
    links.push_back(link);
  }
  return links;
}

/// All keys, and even samples from the first to the last.
std::vector<double> sample_times(const GltfNodeMotion& nodes, double rate) {
  if (nodes.times.empty()) return {0};
  std::vector<double> times = nodes.times;
  const double first = times.front(), span = times.back() - first;
  const double samples = std::ceil(span * rate);
  if ((samples + static_cast<double>(times.size())) * static_cast<double>(nodes.places.size()) >
      max_places)
    throw bad_input("it changes the size of joints, or moves nodes between them, for " +
                        std::to_string(span) + " s: too long to sample",
                    "export it without scale, or in parts");
  for (int i = 1; i < samples; ++i) times.push_back(first + span * (i / samples));
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

/// The motion of a joint since it was bound.
struct Moved {
  Mat3 turn = Mat3::Identity();
  Vec3 head = Vec3::Zero();
};

Moved moved(const GltfBindPose& bind, int index, const std::vector<Affine>& global) {
  if (index < 0) return {};
  const GltfJoint& joint = bind.joints[at(index)];
  const Affine& place = global[at(joint.node)];
  return {nearest_rotation(place.linear() * joint.bind.linear().inverse()), place.translation()};
}

void put_sample(const GltfBindPose& bind, int index, double time, const std::vector<Affine>& global,
                Track& track) {
  const int parent = bind.joints[at(index)].parent;
  const Moved self = moved(bind, index, global), above = moved(bind, parent, global);
  track.rotation.times.push_back(time);
  track.rotation.values.emplace_back(Mat3(above.turn.transpose() * self.turn));
  track.translation.times.push_back(time);
  track.translation.values.push_back(above.turn.transpose() * (self.head - above.head) -
                                     (bound_head(bind, index) - bound_head(bind, parent)));
}

/// The scale of a joint since it was bound that is farthest from 1, along any axis.
double scale_of(const GltfJoint& joint, const std::vector<Affine>& global) {
  const Vec3 scales =
      singular_values(global[at(joint.node)].linear() * joint.bind.linear().inverse()).values;
  return scales[0] * scales[2] > 1 ? scales[0] : scales[2];
}

void note_scale(double scale, IgnoredScale& noted) {
  if (std::abs(std::log(scale)) > std::abs(std::log(noted.factor))) noted.factor = scale;
}

/// Adds samples at all keys and `rate` times a second, linear between, to the tracks of joints
/// whose links are not exact: G B^-1 (G the node's transform, B the bind) places the head, and the
/// nearest rotation turns the bone. Throws bad input (without the path) where that takes more than
/// 2e7 node transforms.
void put_samples(const GltfBindPose& bind, const GltfTree& tree, const GltfNodeMotion& nodes,
                 const std::vector<GltfLink>& links, double rate, Motion& motion) {
  std::vector<Affine> local(nodes.places.size());
  for (const double time : sample_times(nodes, rate)) {
    for (const int node : tree.order) local[at(node)] = nodes.at(node, time);
    const std::vector<Affine> global = global_places(tree, local);
    for (std::size_t i = 0; i < links.size(); ++i) {
      if (links[i].exact) continue;
      put_sample(bind, static_cast<int>(i), time, global, motion.tracks[i]);
      note_scale(scale_of(bind.joints[i], global), motion.ignored_scales[i]);
    }
  }
}

RotationCurve one_key(const Quat& value) {
  RotationCurve curve;
  curve.times = {0};
  curve.values = {value};
  return curve;
}

/// left q right, for values and tangents.
RotationCurve turned(RotationCurve curve, const Quat& left, const Quat& right) {
  for (auto* all : {&curve.values, &curve.in, &curve.out})
    for (Quat& q : *all) q = left * q * right;
  return curve;
}

/// matrix t + shift; tangents do not shift.
Curve<Vec3> mapped(Curve<Vec3> curve, const Mat3& matrix, const Vec3& shift) {
  for (Vec3& value : curve.values) value = matrix * value + shift;
  for (auto* all : {&curve.in, &curve.out})
    for (Vec3& tangent : *all) tangent = matrix * tangent;
  return curve;
}

RotationCurve rotation_of(const GltfBindPose& bind, int index, const GltfLink& link,
                          const GltfNodeMotion& nodes) {
  const GltfJoint& joint = bind.joints[at(index)];
  const Quat left(Mat3(bound_turn(bind, joint.parent) * nearest_rotation(link.between.linear())));
  const Quat right(Mat3(bound_turn(bind, index).transpose()));
  const RotationCurve& curve = nodes.curves[at(joint.node)].rotation;
  if (!curve.empty()) return turned(curve, left, right);
  const Quat own(nearest_rotation(nodes.places[at(joint.node)].affine().linear()));
  const Quat rotation = (left * own * right).normalized();
  return rotation.angularDistance(Quat::Identity()) > motionless ? one_key(rotation)
                                                                 : RotationCurve();
}

Curve<Vec3> translation_of(const GltfBindPose& bind, int index, const GltfLink& link,
                           const GltfNodeMotion& nodes, double size) {
  const GltfJoint& joint = bind.joints[at(index)];
  const Mat3 scaled = link.scale * bound_turn(bind, joint.parent);
  const Mat3 matrix = scaled * link.between.linear();
  const Vec3 shift = scaled * link.between.translation() -
                     (bound_head(bind, index) - bound_head(bind, joint.parent));
  Curve<Vec3> curve = nodes.curves[at(joint.node)].translation;
  if (!curve.empty()) return mapped(std::move(curve), matrix, shift);
  const Vec3 translation = matrix * nodes.places[at(joint.node)].translation + shift;
  if (translation.norm() <= motionless * size) return {};
  curve.times = {0};
  curve.values = {translation};
  return curve;
}

double size_of(const GltfBindPose& bind) {
  Box box;
  for (const GltfJoint& joint : bind.joints) box.extend(joint.bind.translation());
  return box.diagonal().norm();
}

bool is_finite(const Track& track) {
  const auto finite = [](const auto& values, const auto& parts) {
    return std::all_of(values.begin(), values.end(),
                       [&](const auto& value) { return parts(value).allFinite(); });
  };
  const auto itself = [](const Vec3& value) { return value; };
  const auto coefficients = [](const Quat& value) { return value.coeffs(); };
  return finite(track.translation.values, itself) && finite(track.translation.in, itself) &&
         finite(track.translation.out, itself) && finite(track.rotation.values, coefficients);
}

}  // namespace

Motion joint_motion(const GltfBindPose& bind, const GltfTree& tree, const GltfNodeMotion& nodes,
                    double rate) {
  const std::vector<GltfLink> links = joint_links(bind, tree, nodes);
  const double size = size_of(bind);
  Motion motion;
  std::vector<Track>& tracks = motion.tracks;
  tracks.resize(links.size());
  const std::vector<Affine> still = global_places(tree, still_places(nodes));
  bool sampled = false;
  for (std::size_t i = 0; i < links.size(); ++i) {
    const int index = static_cast<int>(i);
    tracks[i].bone = index;
    motion.ignored_scales.push_back({index, 1});
    sampled = sampled || !links[i].exact;
    if (!links[i].exact) continue;
    note_scale(scale_of(bind.joints[i], still), motion.ignored_scales.back());
    tracks[i].rotation = rotation_of(bind, index, links[i], nodes);
    tracks[i].translation = translation_of(bind, index, links[i], nodes, size);
  }
  if (sampled) put_samples(bind, tree, nodes, links, rate, motion);
  for (std::size_t i = 0; i < tracks.size(); ++i)
    if (!is_finite(tracks[i]))
      throw bad_input("it moves joint " + std::to_string(i) + " out of all finite places",
                      "export it again");
  std::erase_if(motion.ignored_scales,
                [](const IgnoredScale& one) { return std::abs(one.factor - 1) < unnoticed_scale; });
  std::erase_if(tracks, [](const Track& track) {
    return track.rotation.empty() && track.translation.empty();
  });
  return motion;
}

}  // namespace sinew
