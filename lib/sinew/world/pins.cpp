// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/world/pins.h>

#include <string>

#include <sinew/core/error.h>
#include <sinew/core/parallel.h>

namespace sinew {
namespace {

constexpr std::size_t particles_per_search = 4096;
constexpr std::uint32_t no_pin = UINT32_MAX;

std::string name_of(std::size_t pin) { return "pin " + std::to_string(pin); }

bool holds(const Pin& pin, const Vec3& point) {
  return Region{pin.region.shape, 0}.weight(point) > 0;
}

/// The first pin that contains each point.
std::vector<std::uint32_t> pin_of_each(const Points& rest, const std::vector<Pin>& pins) {
  std::vector<std::uint32_t> first(rest.size(), no_pin);
  parallel_for(rest.size(), particles_per_search, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = pins.size(); p-- > 0;)
      for (std::size_t i = begin; i < end; ++i)
        if (holds(pins[p], rest[i])) first[i] = static_cast<std::uint32_t>(p);
  });
  return first;
}

void check_pin(const Pin& pin, const std::string& name, int bones) {
  check_region(pin.region, name);
  if (pin.bone != no_bone && (pin.bone < 0 || pin.bone >= bones))
    throw bad_input(
        name + " is fixed to bone " + std::to_string(pin.bone) + " of " + std::to_string(bones),
        "name a bone of the skeleton");
}

}  // namespace

std::vector<Pinned> pinned(const Points& rest, const std::vector<Pin>& pins, int bones) {
  for (std::size_t p = 0; p < pins.size(); ++p) check_pin(pins[p], name_of(p), bones);
  const auto first = pin_of_each(rest, pins);
  std::vector<std::size_t> held(pins.size(), 0);
  std::vector<Pinned> all;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    if (first[i] == no_pin) continue;
    all.push_back({static_cast<std::uint32_t>(i), pins[first[i]].bone});
    ++held[first[i]];
  }
  for (std::size_t p = 0; p < pins.size(); ++p)
    if (held[p] == 0)
      throw bad_input(name_of(p) + " holds 0 particles that no pin before it holds",
                      "place its region on the body at rest");
  return all;
}

PinPose pin_pose(const Pinned& pin, const Vec3& rest, const Skeleton& skeleton, const Pose& pose) {
  if (pin.bone == no_bone) return {rest, Vec3::Zero()};
  const auto bone = static_cast<std::size_t>(pin.bone);
  const Vec3 position = carried(rest, skeleton.bones.at(bone).rest, pose.at(bone).frame);
  return {position, pose[bone].velocity_at(position)};
}

void add_reaction(const Pinned& pin, const PinPose& at, const Vec3& unheld, const Pose& pose,
                  std::vector<Reaction>& of_bones) {
  if (pin.bone == no_bone) return;
  const auto bone = static_cast<std::size_t>(pin.bone);
  Reaction& on = of_bones[bone];
  on.force += unheld;
  on.moment += (at.position - pose[bone].frame.origin).cross(unheld);
  on.power -= unheld.dot(at.velocity);
}

}  // namespace sinew
