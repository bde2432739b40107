// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/run/moment_arrays.h>

#include <algorithm>
#include <limits>
#include <string>

#include <sinew/body/bone_force.h>
#include <sinew/core/error.h>
#include <sinew/core/parallel.h>

namespace sinew {
namespace {

constexpr std::size_t particles_per_task = 512;

/// Three components of each particle, by id.
template <class Value>
Column vectors(std::string_view name, std::size_t count, const Value& value) {
  std::vector<double> numbers(3 * count);
  parallel_for(count, particles_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) Eigen::Map<Vec3>(numbers.data() + 3 * i) = value(i);
  });
  Column made = column(std::string(name), std::move(numbers));
  made.components = 3;
  return made;
}

Column accelerations(const BodyMoment& moment, std::string_view name) {
  std::vector<std::uint32_t> place(moment.now.id.size());
  for (std::size_t i = 0; i < place.size(); ++i)
    place[static_cast<std::size_t>(moment.now.id[i])] = static_cast<std::uint32_t>(i);
  return vectors(name, place.size(), [&](std::size_t id) -> Vec3 {
    const double mass = mass_of(moment.body, id, moment.now.mass);
    return moment.forces.total(place[id]) / mass + moment.gravity;
  });
}

Column bone_points(const BodyMoment& moment, std::string_view name) {
  const Body& body = moment.body;
  return vectors(name, body.rest.size(), [&](std::size_t id) -> Vec3 {
    const auto bones = body.binding.of(id);
    if (bones.empty()) return Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
    const auto b = static_cast<std::size_t>(bones.front().bone);
    return carried_foot(bones.front(), body.skeleton.bones[b], moment.pose[b]);
  });
}

/// Adds up the pulls of all bones on each particle, by id.
std::vector<BonePull> pulls_of(const BodyMoment& moment) {
  const Body& body = moment.body;
  std::vector<BonePull> sums(body.rest.size());
  parallel_for(sums.size(), particles_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t id = begin; id < end; ++id) {
      const ParticleState particle{body.rest[id], moment.positions[id], Vec3::Zero(),
                                   moment.now.radius};
      for (const Influence& influence : body.binding.of(id)) {
        const auto b = static_cast<std::size_t>(influence.bone);
        const BonePull pull =
            bone_pull(body.springs[b], influence, body.skeleton.bones[b], moment.pose[b], particle);
        for (const auto part : {&BonePull::radial, &BonePull::twist, &BonePull::axial})
          sums[id].*part += pull.*part;
      }
    }
  });
  return sums;
}

}  // namespace

std::vector<Column> moment_arrays(const BodyMoment& moment,
                                  std::span<const std::string_view> names) {
  std::vector<Column> columns;
  std::vector<BonePull> pulls;  // once they are asked for
  const auto add_part = [&](std::string_view name, Vec3 BonePull::*part) {
    if (pulls.empty()) pulls = pulls_of(moment);
    columns.push_back(
        vectors(name, pulls.size(), [&](std::size_t id) -> Vec3 { return pulls[id].*part; }));
  };
  for (const std::string_view name : names) {
    if (name == "acceleration") columns.push_back(accelerations(moment, name));
    if (name == "bone_point") columns.push_back(bone_points(moment, name));
    if (name == "force_radial") add_part(name, &BonePull::radial);
    if (name == "force_twist") add_part(name, &BonePull::twist);
    if (name == "force_axial") add_part(name, &BonePull::axial);
  }
  return columns;
}

std::vector<std::string_view> defined_moment_arrays(const Body& body,
                                                    std::vector<std::string_view> names, bool all) {
  if (!body.binding.influences.empty()) return names;
  const auto first = std::partition(names.begin(), names.end(),
                                    [](std::string_view name) { return name == "acceleration"; });
  if (first != names.end() && !all)
    throw bad_input("no particle has a value of " + std::string(*first) + ": none has a bone",
                    "leave it out of the arrays");
  names.erase(first, names.end());
  return names;
}

}  // namespace sinew
