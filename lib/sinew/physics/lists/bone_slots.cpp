// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/physics/lists/bone_slots.h>

#include <algorithm>
#include <cmath>

namespace sinew {
namespace {

// Nearer to the axis than this share of a radius, a particle has no direction across it.
constexpr double least_distance = 1e-6;

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
void hold(const Body& body, const Influence& influence, const Vec3& rest, double center,
          const Units& units, Real* lane) {
  constexpr std::size_t block = kernel::Traits<Real>::block;
  const Bone& bone = body.skeleton.bones[influence.bone];
  const Vec3 local = bone.rest.rotation.transpose() * (rest - bone.head());
  const double r = body.material.pair.r;
  const bool aside = std::hypot(local.y(), local.z()) >= least_distance * r ||
                     body.springs[influence.bone].form == BoneForce::anchor;
  const double distance =
      influence.rest_distance < least_distance * r ? 0 : influence.rest_distance;
  const double fields[kernel::held_fields] = {influence.foot - center, local.x() - center,
                                              aside ? local.y() : 0, aside ? local.z() : 0,
                                              distance};
  for (std::size_t field = 0; field < kernel::held_fields; ++field)
    lane[field * block] = static_cast<Real>(fields[field] / units.length);
}

/// Fills the slots of one block after the other.
template <class Real>
class Filler {
 public:
  static constexpr std::size_t block = kernel::Traits<Real>::block;

  Filler(const Body& body, const Units& units, BoneSlots<Real>& out)
      : body_(body), units_(units), out_(out) {}

  void add(std::span<const std::int32_t> ids) {
    const std::size_t begin = out_.slots.size();
    for (std::size_t lane = 0; lane < ids.size(); ++lane) {
      const auto influences = body_.binding.of(ids[lane]);
      for (const Influence& influence : influences) {
        const std::size_t slot = slot_of(influence.bone, begin);
        hold(body_, influence, body_.rest[ids[lane]], out_.center[influence.bone], units_,
             &out_.held[slot * kernel::held_fields * block + lane]);
        Real* shares = &out_.shares[static_cast<std::size_t>(out_.slots[slot].shares) *
                                        kernel::share_fields * block +
                                    lane];
        shares[kernel::weight * block] = static_cast<Real>(influence.weight);
        shares[kernel::lead * block] = &influence == influences.data() ? Real(1) : Real(0);
      }
    }
    if (out_.slots.size() == begin + 1) forget_shares_of_one();
    out_.first.push_back(static_cast<std::uint32_t>(out_.slots.size()));
  }

 private:
  std::size_t slot_of(int bone, std::size_t begin) {
    for (std::size_t slot = begin; slot < out_.slots.size(); ++slot)
      if (out_.slots[slot].bone == bone) return slot;
    const std::size_t shares = out_.shares.size() / (kernel::share_fields * block);
    out_.slots.push_back({bone, static_cast<std::int32_t>(shares)});
    out_.held.resize(out_.held.size() + kernel::held_fields * block);
    out_.shares.resize(out_.shares.size() + kernel::share_fields * block);
    return out_.slots.size() - 1;
  }

  /// A bone that holds every lane alone needs no weights.
  void forget_shares_of_one() {
    const std::size_t begin = out_.shares.size() - kernel::share_fields * block;
    if (!std::all_of(out_.shares.begin() + static_cast<std::ptrdiff_t>(begin), out_.shares.end(),
                     [](Real share) { return share == 1; }))
      return;
    out_.slots.back().shares = -1;
    out_.shares.resize(begin);
  }

  const Body& body_;
  const Units& units_;
  BoneSlots<Real>& out_;
};

/// Slots that the blocks will need: a vector that grows by doubling would be half empty.
std::size_t count_slots(const Body& body, std::span<const std::int32_t> id, std::size_t block) {
  std::size_t count = 0;
  std::vector<int> bones;
  for (std::size_t begin = 0; begin < id.size(); begin += block) {
    bones.clear();
    for (const std::int32_t i : id.subspan(begin, std::min(block, id.size() - begin)))
      for (const Influence& influence : body.binding.of(i))
        if (std::find(bones.begin(), bones.end(), influence.bone) == bones.end())
          bones.push_back(influence.bone);
    count += bones.size();
  }
  return count;
}

template <class Real>
void put(const Vec3& from, double scale, Real* to) {
  for (int axis = 0; axis < 3; ++axis) to[axis] = static_cast<Real>(from[axis] * scale);
}

/// A point as integers and a remainder, both in lengths of the kernel.
void put_center(const Vec3& p, const Units&, kernel::FrameNow<double>& frame) {
  put(p, 1, frame.center);
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
  constexpr std::size_t block = kernel::Traits<Real>::block;
  BoneSlots<Real> slots;
  slots.center = centers(body);
  const std::size_t count = count_slots(body, id, block);
  slots.slots.reserve(count);
  slots.held.reserve(count * kernel::held_fields * block);
  slots.first.reserve(id.size() / block + 2);
  slots.first.push_back(0);
  Filler<Real> filler(body, units, slots);
  for (std::size_t begin = 0; begin < id.size(); begin += block)
    filler.add(id.subspan(begin, std::min(block, id.size() - begin)));
  return slots;
}

template <class Real>
std::vector<kernel::BoneNow<Real>> bones_now(const Body& body, const Pose& pose,
                                             std::span<const double> center, double mass,
                                             const Units& units) {
  std::vector<kernel::BoneNow<Real>> bones(pose.size());
  const double spring = units.time * units.time / mass;
  for (std::size_t b = 0; b < pose.size(); ++b) {
    const Vec3 at = pose[b].frame.origin + pose[b].stretch * center[b] * pose[b].axis();
    const BoneSprings& springs = body.springs[b];
    bones[b].frame = frame_now<Real>(pose[b], at, units);
    bones[b].radial = static_cast<Real>(springs.radial * spring);
    bones[b].twist = static_cast<Real>(springs.twist * spring);
    bones[b].axial = static_cast<Real>(springs.axial * spring);
    bones[b].damping = static_cast<Real>(springs.damping * units.time / mass);
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
