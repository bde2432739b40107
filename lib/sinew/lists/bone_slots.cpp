// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/lists/bone_slots.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <sinew/core/parallel.h>

namespace sinew {
namespace {

// Nearer to the axis than this fraction of a radius, a particle has no direction across it.
constexpr double min_distance = 1e-6;

double place_along(const Bone& bone, const Vec3& point) {
  return (point - bone.head()).dot(bone.axis());
}

std::vector<double> centers(const Body& body) {
  std::vector<double> sum(body.skeleton.size(), 0.0), weight(body.skeleton.size(), 0.0);
  for (std::size_t i = 0; i < body.rest.size(); ++i)
    for (const Influence& influence : body.binding.of(i)) {
      sum[influence.bone] += place_along(body.skeleton.bones[influence.bone], body.rest[i]);
      weight[influence.bone] += 1;
    }
  for (std::size_t b = 0; b < sum.size(); ++b)
    if (weight[b] > 0) sum[b] /= weight[b];
  return sum;
}

/// Writes the fields of one lane.
template <class Real>
void put_attachment(const Body& body, const Influence& influence, const Vec3& rest, double center,
                    const Units& units, Real* lane) {
  constexpr std::size_t block = kernel::Traits<Real>::block;
  const Bone& bone = body.skeleton.bones[influence.bone];
  const Vec3 local = bone.rest.rotation.transpose() * (rest - bone.head());
  const double r = body.material.pair.r;
  const double across = local.y() * local.y() + local.z() * local.z();
  const bool aside = across >= min_distance * min_distance * r * r ||
                     body.springs[influence.bone].form == BoneForce::anchor;
  const double at_rest = influence.distance_to(bone, rest);
  const double distance = at_rest < min_distance * r ? 0 : at_rest;
  const double fields[kernel::attachment_fields] = {influence.foot - center, local.x() - center,
                                                    aside ? local.y() : 0, aside ? local.z() : 0,
                                                    distance};
  for (std::size_t field = 0; field < kernel::attachment_fields; ++field)
    lane[field * block] = static_cast<Real>(fields[field] / units.length);
}

/// The bones to which particles of a block are bound, in the order of their first ones.
void find_bones(const Body& body, std::span<const std::int32_t> ids, std::vector<int>& bones) {
  bones.clear();
  for (const std::int32_t id : ids)
    for (const Influence& influence : body.binding.of(id))
      if (std::find(bones.begin(), bones.end(), influence.bone) == bones.end())
        bones.push_back(influence.bone);
}

/// Makes the slots block by block.
template <class Real>
class Filler {
 public:
  static constexpr std::size_t block = kernel::Traits<Real>::block;

  Filler(const Body& body, std::span<const std::int32_t> id, const Units& units,
         BoneSlots<Real>& out)
      : body_(body), id_(id), units_(units), out_(out) {}

  void fill() {
    count();
    out_.slots.resize(out_.first.back());
    out_.attachments.resize(out_.first.back() * kernel::attachment_fields * block);
    out_.weights.resize(first_weights_.back() * kernel::weight_fields * block);
    on_all_blocks([&](std::size_t b, const std::vector<int>& bones) { fill(b, bones); });
  }

 private:
  static constexpr std::size_t blocks_per_task = 512;

  std::span<const std::int32_t> ids(std::size_t b) const {
    return id_.subspan(b * block, std::min(block, id_.size() - b * block));
  }

  /// Calls visit(block, its bones).
  template <class Visit>
  void on_all_blocks(const Visit& visit) const {
    parallel_for((id_.size() + block - 1) / block, blocks_per_task,
                 [&](std::size_t begin, std::size_t end) {
                   std::vector<int> bones;
                   for (std::size_t b = begin; b < end; ++b) {
                     find_bones(body_, ids(b), bones);
                     visit(b, bones);
                   }
                 });
  }

  /// A bone to which every lane is bound alone needs no weights.
  bool weights_are_one(std::size_t b, const std::vector<int>& bones) const {
    const auto alone = [&](std::int32_t id) {
      const auto influences = body_.binding.of(id);
      return influences.size() == 1 && static_cast<Real>(influences[0].weight) == 1;
    };
    const auto all = ids(b);
    return bones.size() == 1 && all.size() == block && std::all_of(all.begin(), all.end(), alone);
  }

  /// Where each block's slots and weights begin.
  void count() {
    out_.first.assign((id_.size() + block - 1) / block + 1, 0);
    first_weights_ = out_.first;
    on_all_blocks([&](std::size_t b, const std::vector<int>& bones) {
      out_.first[b + 1] = static_cast<std::uint32_t>(bones.size());
      first_weights_[b + 1] = weights_are_one(b, bones) ? 0 : out_.first[b + 1];
    });
    for (auto* first : {&out_.first, &first_weights_})
      std::partial_sum(first->begin(), first->end(), first->begin());
  }

  void fill(std::size_t b, const std::vector<int>& bones) {
    const std::size_t begin = out_.first[b];
    const bool weighted = first_weights_[b] < first_weights_[b + 1];
    for (std::size_t k = 0; k < bones.size(); ++k)
      out_.slots[begin + k] = {bones[k],
                               weighted ? static_cast<std::int32_t>(first_weights_[b] + k) : -1};
    const auto all = ids(b);
    for (std::size_t lane = 0; lane < all.size(); ++lane) {
      const auto influences = body_.binding.of(all[lane]);
      for (const Influence& influence : influences) {
        const auto k = static_cast<std::size_t>(
            std::find(bones.begin(), bones.end(), influence.bone) - bones.begin());
        put_attachment(body_, influence, body_.rest[all[lane]], out_.center[influence.bone], units_,
                       &out_.attachments[(begin + k) * kernel::attachment_fields * block + lane]);
        if (!weighted) continue;
        Real* weights =
            &out_.weights[(first_weights_[b] + k) * kernel::weight_fields * block + lane];
        weights[kernel::weight * block] = static_cast<Real>(influence.weight);
        weights[kernel::lead * block] = &influence == influences.data() ? Real(1) : Real(0);
      }
    }
  }

  const Body& body_;
  std::span<const std::int32_t> id_;
  const Units& units_;
  BoneSlots<Real>& out_;
  std::vector<std::uint32_t> first_weights_;  ///< blocks + 1 long
};

template <class Real>
void put(const Vec3& from, double scale, Real* to) {
  for (int axis = 0; axis < 3; ++axis) to[axis] = static_cast<Real>(from[axis] * scale);
}

/// A point as integers and a remainder, both in lengths of the kernel.
void put_center(const Vec3& p, const Units& units, kernel::FrameNow<double>& frame) {
  put(Vec3(p - units.origin), 1, frame.center);
  put(Vec3(Vec3::Zero()), 1, frame.rest_of_center);
}

void put_center(const Vec3& p, const Units& units, kernel::FrameNow<float>& frame) {
  const Vec3 scaled = (p - units.origin) / units.length;
  for (int axis = 0; axis < 3; ++axis) {
    const double whole = std::nearbyint(scaled[axis]);
    frame.center[axis] = static_cast<std::int32_t>(static_cast<std::int64_t>(whole));
    frame.rest_of_center[axis] = static_cast<float>(scaled[axis] - whole);
  }
}

template <class Real>
void put_axes(const Mat3& rotation, Real* axes) {
  for (int axis = 0; axis < 3; ++axis) put(Vec3(rotation.col(axis)), 1, axes + 3 * axis);
}

kernel::BonePulls pulls_of(const BoneSprings& springs) {
  if (springs.form == BoneForce::anchor) return kernel::anchor;
  return springs.twist_form == TwistForm::open_loop ? kernel::open_loop : kernel::servo;
}

}  // namespace

template <class Real>
kernel::FrameNow<Real> frame_now(const BonePose& pose, const Vec3& center, const Units& units) {
  kernel::FrameNow<Real> frame{};
  put_center(center, units, frame);
  put_axes(pose.frame.rotation, frame.axes);
  put(pose.rigid_velocity_at(center), units.velocity(1), frame.velocity);
  put(pose.angular_velocity, units.time, frame.spin);
  return frame;
}

template kernel::FrameNow<double> frame_now(const BonePose&, const Vec3&, const Units&);
template kernel::FrameNow<float> frame_now(const BonePose&, const Vec3&, const Units&);

template <class Real>
BoneSlots<Real> bone_slots(const Body& body, std::span<const std::int32_t> id, const Units& units) {
  BoneSlots<Real> slots;
  slots.center = centers(body);
  Filler<Real>(body, id, units, slots).fill();
  return slots;
}

template <class Real>
std::vector<kernel::BoneNow<Real>> bones_now(const Body& body, const Pose& pose,
                                             std::span<const double> center, double mass,
                                             const Units& units) {
  std::vector<kernel::BoneNow<Real>> bones(pose.size());
  const double spring = units.time * units.time / mass, length2 = units.length * units.length;
  for (std::size_t b = 0; b < pose.size(); ++b) {
    const Vec3 at = pose[b].frame.origin + pose[b].stretch * center[b] * pose[b].axis();
    const BoneSprings& springs = body.springs[b];
    bones[b].frame = frame_now<Real>(pose[b], at, units);
    bones[b].radial = static_cast<Real>(springs.radial * spring);
    bones[b].twist = static_cast<Real>(springs.twist * spring);
    bones[b].axial = static_cast<Real>(springs.axial * spring);
    bones[b].damping = static_cast<Real>(springs.damping * units.time / mass);
    bones[b].yield = static_cast<Real>(2 * springs.yield_energy() * spring / length2);
    bones[b].pulls = pulls_of(springs);
    bones[b].turning = static_cast<Real>(springs.twist * pose[b].twist * spring);
    bones[b].center = static_cast<Real>(center[b] / units.length);
    bones[b].stretch = static_cast<Real>(pose[b].stretch);
    bones[b].stretch_rate = static_cast<Real>(pose[b].stretch_rate * units.time);
  }
  return bones;
}

template struct BoneSlots<double>;
template struct BoneSlots<float>;
template BoneSlots<double> bone_slots(const Body&, std::span<const std::int32_t>, const Units&);
template BoneSlots<float> bone_slots(const Body&, std::span<const std::int32_t>, const Units&);
template std::vector<kernel::BoneNow<double>> bones_now(const Body&, const Pose&,
                                                        std::span<const double>, double,
                                                        const Units&);
template std::vector<kernel::BoneNow<float>> bones_now(const Body&, const Pose&,
                                                       std::span<const double>, double,
                                                       const Units&);

}  // namespace sinew
