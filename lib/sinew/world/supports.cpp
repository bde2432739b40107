// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/world/supports.h>

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include <sinew/core/error.h>
#include <sinew/world/world.h>

namespace sinew {
namespace {

constexpr const char* axis_names[] = {"x", "y", "z"};

std::string name_of(const Support& support) { return "support '" + support.name + '\''; }

void check_support(const Support& support, std::size_t particles) {
  if (support.particles.empty())
    throw bad_input(name_of(support) + " holds no particles",
                    "place its region on the body at rest");
  if (support.particles.back() >= particles)
    throw bad_input(name_of(support) + " holds particle " +
                        std::to_string(support.particles.back()) + " of " +
                        std::to_string(particles),
                    "give numbers of particles of the body");
  if (std::none_of(support.holds.begin(), support.holds.end(), [](bool held) { return held; }))
    throw bad_input(name_of(support) + " holds no axis", "let it hold x, y or z");
}

/// Two supports that hold the same component, which at least one of them moves.
struct Conflict {
  std::int32_t first, second;
  int axis;
  bool operator<(const Conflict& other) const {
    return std::tie(first, second, axis) < std::tie(other.first, other.second, other.axis);
  }
};

[[noreturn]] void refuse(const Conflict& one, std::size_t particles, const World& world) {
  const auto name = [&](std::int32_t k) {
    return '\'' + world.supports[static_cast<std::size_t>(k)].name + '\'';
  };
  throw bad_value("supports[" + std::to_string(one.second) + ']',
                  "supports " + name(one.first) + " and " + name(one.second) + " both hold " +
                      axis_names[one.axis] + " of " + std::to_string(particles) +
                      " particles, and move them differently",
                  "make their regions disjoint, or let one of them hold other axes");
}

/// What supports hold, by particle.
class Holder {
 public:
  Holder(const World& world, std::size_t particles) : world_(world), place_(particles, nowhere) {
    for (const Pinned& pin : world.pins) add(pin);
  }

  void add_support(std::int32_t index) {
    const Support& support = world_.supports[static_cast<std::size_t>(index)];
    for (const std::uint32_t particle : support.particles) {
      const bool fresh = place_[particle] == nowhere;
      if (fresh)
        add({particle});
      else if (held_[place_[particle]].is_pin())
        throw bad_value(path_of(support),
                        name_of(support) + " holds particle " + std::to_string(particle) +
                            ", which world.pins hold",
                        "make their regions disjoint, or replace the pin by a support");
      Pinned& pin = held_[place_[particle]];
      if (!fresh && (pin.is_oblique() || !support.along.isZero(0))) refuse_oblique(support, pin);
      if (!support.along.isZero(0)) {
        pin.support[0] = index;
        pin.along = support.along;
        continue;
      }
      for (int axis = 0; axis < 3; ++axis)
        if (support.holds[static_cast<std::size_t>(axis)]) hold(index, axis, pin);
    }
  }

  std::vector<Pinned> pins() {
    if (!conflicts_.empty()) refuse(conflicts_.begin()->first, conflicts_.begin()->second, world_);
    std::sort(held_.begin(), held_.end(),
              [](const Pinned& a, const Pinned& b) { return a.particle < b.particle; });
    return std::move(held_);
  }

 private:
  static constexpr std::size_t nowhere = SIZE_MAX;

  [[noreturn]] void refuse_oblique(const Support& support, const Pinned& pin) const {
    const std::int32_t other = *std::max_element(pin.support.begin(), pin.support.end());
    throw bad_value(path_of(support),
                    "supports '" + world_.supports[static_cast<std::size_t>(other)].name +
                        "' and '" + support.name + "' both hold particle " +
                        std::to_string(pin.particle) + ", one of them along an oblique direction",
                    "make their regions disjoint");
  }

  std::string path_of(const Support& support) const {
    return "supports[" + std::to_string(&support - world_.supports.data()) + ']';
  }

  void add(const Pinned& pin) {
    place_[pin.particle] = held_.size();
    held_.push_back(pin);
  }

  bool moves(std::int32_t index) const {
    return world_.supports[static_cast<std::size_t>(index)].motion != nullptr;
  }

  void hold(std::int32_t index, int axis, Pinned& pin) {
    std::int32_t& holder = pin.support[static_cast<std::size_t>(axis)];
    if (holder == no_support)
      holder = index;
    else if (moves(holder) || moves(index))
      ++conflicts_[{holder, index, axis}];
  }

  const World& world_;
  std::vector<std::size_t> place_;  ///< in `held_`, by particle
  std::vector<Pinned> held_;
  std::map<Conflict, std::size_t> conflicts_;  ///< with the number of particles
};

}  // namespace

void hold(World& world, std::size_t particles) {
  for (const Support& support : world.supports) check_support(support, particles);
  if (world.supports.empty()) return;
  Holder holder(world, particles);
  for (std::size_t k = 0; k < world.supports.size(); ++k)
    holder.add_support(static_cast<std::int32_t>(k));
  world.pins = holder.pins();
}

std::vector<ObstaclePose> poses_of(std::span<const Support> supports, double time,
                                   const Pose& pose) {
  std::vector<ObstaclePose> poses;
  for (const Support& support : supports) {
    ObstaclePose& now = poses.emplace_back();
    now.frame.origin = support.pivot;
    if (support.motion) now = support.motion(time, pose);
  }
  return poses;
}

namespace {

/// Where one support puts a particle: exactly at rest where the support is.
PinPose place_by(std::span<const Support> supports, std::span<const ObstaclePose> now,
                 std::int32_t index, const Vec3& rest) {
  const auto k = static_cast<std::size_t>(index);
  const Vec3& pivot = supports[k].pivot;
  const RigidFrame& frame = now[k].frame;
  const Vec3 place =
      rest + ((frame.origin - pivot) + (frame.rotation - Mat3::Identity()) * (rest - pivot));
  return {place, now[k].velocity_at(place)};
}

}  // namespace

PinPose place_of(const Pinned& held, const Vec3& rest, std::span<const Support> supports,
                 std::span<const ObstaclePose> now) {
  PinPose at{rest, Vec3::Zero()};
  if (held.is_oblique()) return place_by(supports, now, held.support[0], rest);
  for (int axis = 0; axis < 3; ++axis) {
    const std::int32_t index = held.support[static_cast<std::size_t>(axis)];
    if (index == no_support) continue;
    const PinPose place = place_by(supports, now, index, rest);
    at.position[axis] = place.position[axis];
    at.velocity[axis] = place.velocity[axis];
  }
  return at;
}

void add_answer(const Pinned& held, const PinPose& at, const Vec3& answer,
                std::span<const ObstaclePose> now, std::span<Reaction> support_reactions) {
  if (held.is_oblique()) {
    const auto k = static_cast<std::size_t>(held.support[0]);
    const Vec3 force = held_part(held, answer);
    support_reactions[k] +=
        {force, (at.position - now[k].frame.origin).cross(force), force.dot(at.velocity)};
    return;
  }
  for (int axis = 0; axis < 3; ++axis) {
    const std::int32_t index = held.support[static_cast<std::size_t>(axis)];
    if (index == no_support) continue;
    const auto k = static_cast<std::size_t>(index);
    Vec3 force = Vec3::Zero();
    force[axis] = answer[axis];
    support_reactions[k] +=
        {force, (at.position - now[k].frame.origin).cross(force), answer[axis] * at.velocity[axis]};
  }
}

Vec3 held_part(const Pinned& held, const Vec3& all) {
  Vec3 part = Vec3::Zero();
  if (held.is_oblique()) return held.along.dot(all) * held.along;
  for (int axis = 0; axis < 3; ++axis)
    if (held.holds(axis)) part[axis] = all[axis];
  return part;
}

}  // namespace sinew
