// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/joint_tracks.h>

#include <algorithm>

#include <sinew/core/error.h>
#include <sinew/io/gltf/joint_samples.h>

namespace sinew {
namespace {

constexpr double still = 1e-6;  // rad, and of the skeleton's size

std::size_t at(int index) { return static_cast<std::size_t>(index); }

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
  return rotation.angularDistance(Quat::Identity()) > still ? one_key(rotation) : RotationCurve();
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
  if (translation.norm() <= still * size) return {};
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
  std::vector<Track> tracks(links.size());
  bool sampled = false;
  for (std::size_t i = 0; i < links.size(); ++i) {
    const int index = static_cast<int>(i);
    tracks[i].bone = index;
    sampled = sampled || !links[i].exact;
    if (!links[i].exact) continue;
    tracks[i].rotation = rotation_of(bind, index, links[i], nodes);
    tracks[i].translation = translation_of(bind, index, links[i], nodes, size);
  }
  if (sampled) put_samples(bind, tree, nodes, links, rate, tracks);
  for (std::size_t i = 0; i < tracks.size(); ++i)
    if (!is_finite(tracks[i]))
      throw bad_input("it moves joint " + std::to_string(i) + " out of all finite places",
                      "export it again");
  std::erase_if(tracks, [](const Track& track) {
    return track.rotation.empty() && track.translation.empty();
  });
  Motion motion;
  motion.tracks = std::move(tracks);
  return motion;
}

}  // namespace sinew
