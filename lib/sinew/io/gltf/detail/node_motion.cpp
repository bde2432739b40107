// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/detail/node_motion.h>

#include <algorithm>

#include <sinew/io/gltf/detail/accessors.h>

namespace sinew {
namespace {

constexpr double still_scale = 1e-5;

std::vector<double> times_of(const CheckedGltf& gltf, const GltfSampler& sampler,
                             const std::string& user) {
  std::vector<double> times = gltf_values(gltf, sampler.times, user + "'s times");
  if (times.front() < 0)
    throw damaged_gltf(user + " begins at the time " + std::to_string(times.front()));
  for (std::size_t i = 1; i < times.size(); ++i)
    if (times[i] < times[i - 1])
      throw damaged_gltf(user + "'s times do not ascend: " + std::to_string(times[i]) + " after " +
                         std::to_string(times[i - 1]));
  return times;
}

Interpolation interpolation_of(const GltfSampler& sampler) {
  switch (sampler.interpolation) {
    case GltfInterpolation::step:
      return Interpolation::step;
    case GltfInterpolation::linear:
      return Interpolation::linear;
    case GltfInterpolation::cubic:
      return Interpolation::cubic;
  }
  return Interpolation::linear;
}

/// The last one of keys at one time, and the first one a little before it: a jump.
template <class Curve>
Curve with_parted_times(const Curve& curve) {
  constexpr double jump = 1e-4;  // fraction of the time since the key before
  const auto& times = curve.times;
  Curve parted;
  parted.interpolation = curve.interpolation;
  const auto add = [&](std::size_t i, double time) {
    parted.times.push_back(time);
    parted.values.push_back(curve.values[i]);
    if (!curve.in.empty()) parted.in.push_back(curve.in[i]);
    if (!curve.out.empty()) parted.out.push_back(curve.out[i]);
  };
  for (std::size_t first = 0, last = 0; first < times.size(); first = last + 1) {
    for (last = first; last + 1 < times.size() && times[last + 1] == times[first];) ++last;
    if (first > 0 && first < last && curve.interpolation != Interpolation::step &&
        curve.values[first] != curve.values[last])
      add(first, times[first] - jump * (times[first] - times[first - 1]));
    add(last, times[last]);
  }
  return parted;
}

/// Distributes the file's values over a curve: one per key, or in-tangent, value and out-tangent.
template <class Curve, class Make>
Curve curve_of(const CheckedGltf& gltf, const GltfSampler& sampler, const std::string& user,
               std::size_t parts, const Make& make) {
  Curve curve;
  curve.interpolation = interpolation_of(sampler);
  curve.times = times_of(gltf, sampler, user);
  const std::vector<double> values = gltf_values(gltf, sampler.values, user + "'s values");
  const bool cubic = sampler.interpolation == GltfInterpolation::cubic;
  for (std::size_t i = 0; i < curve.times.size(); ++i) {
    const double* first = values.data() + i * parts * (cubic ? 3 : 1);
    if (cubic) curve.in.push_back(make(first));
    curve.values.push_back(make(cubic ? first + parts : first));
    if (cubic) curve.out.push_back(make(first + 2 * parts));
  }
  return with_parted_times(curve);
}

Curve<Vec3> vectors(const CheckedGltf& gltf, const GltfSampler& sampler, const std::string& user) {
  return curve_of<Curve<Vec3>>(gltf, sampler, user, 3,
                               [](const double* x) { return Vec3(x[0], x[1], x[2]); });
}

RotationCurve rotations(const CheckedGltf& gltf, const GltfSampler& sampler,
                        const std::string& user) {
  auto curve = curve_of<RotationCurve>(
      gltf, sampler, user, 4, [](const double* x) { return Quat(x[3], x[0], x[1], x[2]); });
  for (Quat& value : curve.values) {
    if (!(value.norm() > 0)) throw damaged_gltf(user + " has a rotation of length 0");
    value.normalize();
  }
  return curve;
}

bool is_still(const Curve<Vec3>& curve, double tolerance) {
  const auto same = [&](const Vec3& value) {
    return (value - curve.values[0]).cwiseAbs().maxCoeff() <=
           tolerance * curve.values[0].cwiseAbs().minCoeff();
  };
  const auto none = [](const Vec3& tangent) { return tangent.isZero(0); };
  return std::all_of(curve.values.begin(), curve.values.end(), same) &&
         std::all_of(curve.in.begin(), curve.in.end(), none) &&
         std::all_of(curve.out.begin(), curve.out.end(), none);
}

bool is_still(const RotationCurve& curve) {
  const auto same = [&](const Quat& value) { return value.coeffs() == curve.values[0].coeffs(); };
  const auto none = [](const Quat& tangent) { return tangent.coeffs().isZero(0); };
  return std::all_of(curve.values.begin(), curve.values.end(), same) &&
         std::all_of(curve.in.begin(), curve.in.end(), none) &&
         std::all_of(curve.out.begin(), curve.out.end(), none);
}

/// An animated curve, or its constant value.
template <class Curve, class Value>
void put(Curve curve, bool still, Curve& moving, Value& place) {
  if (still) place = curve.values[0];
  if (!still) moving = std::move(curve);
}

void put_channel(const CheckedGltf& gltf, const GltfSampler& sampler, const GltfChannel& channel,
                 const std::string& user, GltfNodeMotion& motion) {
  const auto node = static_cast<std::size_t>(channel.node);
  GltfPlace& place = motion.places[node];
  GltfNodeCurves& curves = motion.curves[node];
  if (channel.path == GltfPath::rotation) {
    RotationCurve curve = rotations(gltf, sampler, user);
    motion.times.insert(motion.times.end(), curve.times.begin(), curve.times.end());
    const bool still = is_still(curve);
    return put(std::move(curve), still, curves.rotation, place.rotation);
  }
  const bool scale = channel.path == GltfPath::scale;
  Curve<Vec3> curve = vectors(gltf, sampler, user);
  motion.times.insert(motion.times.end(), curve.times.begin(), curve.times.end());
  const bool still = is_still(curve, scale ? still_scale : 0);
  put(std::move(curve), still, scale ? curves.scale : curves.translation,
      scale ? place.scale : place.translation);
}

}  // namespace

Affine GltfNodeMotion::at(int node, double time) const {
  const GltfNodeCurves& moving = curves[static_cast<std::size_t>(node)];
  GltfPlace place = places[static_cast<std::size_t>(node)];
  if (!moving.translation.empty()) place.translation = moving.translation.at(time).value;
  if (!moving.rotation.empty()) place.rotation = moving.rotation.at(time).value;
  if (!moving.scale.empty()) place.scale = moving.scale.at(time).value;
  return place.affine();
}

GltfNodeMotion gltf_node_motion(const CheckedGltf& gltf, std::size_t index) {
  const GltfAnimation& animation = gltf.document.animations[index];
  GltfNodeMotion motion;
  for (const GltfNode& node : gltf.document.nodes) motion.places.push_back(place_of(node));
  motion.curves.resize(motion.places.size());
  for (std::size_t i = 0; i < animation.channels.size(); ++i) {
    const GltfChannel& channel = animation.channels[i];
    put_channel(gltf, animation.samplers[static_cast<std::size_t>(channel.sampler)], channel,
                nth("animations", index) + ".samplers[" + std::to_string(channel.sampler) + "]",
                motion);
  }
  std::sort(motion.times.begin(), motion.times.end());
  motion.times.erase(std::unique(motion.times.begin(), motion.times.end()), motion.times.end());
  return motion;
}

}  // namespace sinew
