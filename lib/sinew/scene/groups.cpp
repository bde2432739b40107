// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/groups.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include <sinew/core/error.h>
#include <sinew/core/particles.h>
#include <sinew/groups/kept_free.h>
#include <sinew/groups/static_groups.h>
#include <sinew/scene/context.h>
#include <sinew/scene/rig.h>

namespace sinew {
namespace {

// Free up to here from joints, in square roots of the cross-section. What cubics lose falls with
// the distance; in radii, it grows with the layers across. Measured on bars that bend by 90
// degrees, and on an arm that closes its fingers.
constexpr double affine_distance = 1, cubic_distance = 0.52;
constexpr double with_layers = 0.39, layers_measured = 45;

/// Returns the distance of the widest bone: within half a radius of the motion without groups.
double cubic_distance_of(const Body& body) {
  double widest = 0;
  for (const double section : body.binding.cross_section) widest = std::max(widest, section);
  const double layers = std::sqrt(widest) / half_plane_spacing(body.material.pair.r);
  return cubic_distance + with_layers * std::log(std::max(1.0, layers / layers_measured));
}

void check_groups(const Settings& settings, const Body& body) {
  with_context(settings, "hierarchy.enabled", [&] { check_groupable(body); });
  if (settings.hierarchy.dynamic)
    with_context(settings, "hierarchy.dynamic", [&] { check_groupable_as_it_moves(body); });
  if (settings.hierarchy.motion != GroupForm::cubic) return;
  if (!supports_cubic_groups(body))
    throw bad_input(settings.place("hierarchy.motion"),
                    "only in bonded bodies without volume terms, pairwise damping and obstacles do "
                    "groups move by cubics",
                    "set hierarchy.motion to auto");
}

/// Names between commas.
std::vector<std::string> names_in(std::string_view text) {
  std::vector<std::string> names;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(','), text.size());
    std::string_view name = text.substr(0, end);
    name.remove_prefix(std::min(name.find_first_not_of(' '), name.size()));
    name.remove_suffix(name.size() - std::min(name.find_last_not_of(' ') + 1, name.size()));
    if (!name.empty()) names.emplace_back(name);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return names;
}

AskedFree asked_free(const Settings& settings, const Body& body) {
  const HierarchySettings& given = settings.hierarchy;
  AskedFree asked;
  asked.surface_distance = given.surface_distance;
  for (const std::string& name : names_in(given.free_bones))
    asked.bones.push_back(bone_of(settings, "hierarchy.free_bones", body.skeleton, name));
  if (!given.free_region) return asked;
  const auto& [x0, y0, z0, x1, y1, z1] = *given.free_region;
  asked.region = Box(Vec3(x0, y0, z0), Vec3(x1, y1, z1));
  if (std::none_of(body.rest.begin(), body.rest.end(),
                   [&](const Vec3& at) { return asked.region->contains(at); }))
    throw bad_input(settings.place("hierarchy.free_region"), "no particle is in it at rest",
                    "give the least and the greatest corner of a box that meets the body, in "
                    "meters, as in [0, 0, 0, 0.1, 0.1, 0.1]");
  return asked;
}

/// Marks what the scene asks for, and where a group would be too stiff.
std::vector<std::uint8_t> free_particles(const Settings& settings, const Body& body,
                                         const Motion& motion) {
  const double end = settings.solver.duration;
  std::vector<std::uint8_t> free = kept_free(body, asked_free(settings, body));
  for (const auto& marks :
       {near_obstacles(body, motion, end), touching_bodies(body, motion, end)}) {
    free.resize(std::max(free.size(), marks.size()), 0);
    for (std::size_t i = 0; i < marks.size(); ++i) free[i] |= marks[i];
  }
  return free;
}

}  // namespace

/// Groups are cubic where they may, unless the scene says otherwise.
std::optional<GroupSizes> group_sizes(const Settings& settings, const Body& body,
                                      const Motion& motion) {
  const HierarchySettings& asked = settings.hierarchy;
  if (!asked.enabled) return {};
  check_groups(settings, body);
  GroupSizes sizes;
  sizes.joint_distance = asked.joint_distance.value_or(affine_distance);
  sizes.min_particles = static_cast<std::size_t>(asked.min_particles);
  sizes.kept_free = free_particles(settings, body, motion);
  if (asked.motion == GroupForm::affine || !supports_cubic_groups(body)) return sizes;
  sizes.cubic_distance = asked.joint_distance.value_or(cubic_distance_of(body));
  sizes.min_cubic = std::max(sizes.min_particles, sizes.min_cubic);
  return sizes;
}

std::shared_ptr<const Grouping> groups_that_stay(const Settings& settings, const Body& body,
                                                 const Motion& motion, const GroupSizes& sizes) {
  const auto moves = moving_joints(body.skeleton, motion, settings.solver.duration);
  return std::make_shared<const Grouping>(static_groups(body, moves, sizes));
}

double groups_pay_from(const Grouping& grouping, const GroupSizes& sizes, double time_ratio) {
  const auto all = static_cast<double>(grouping.group.size());
  const auto grouped = static_cast<double>(grouping.grouped());
  const double rim = grouped - static_cast<double>(grouping.inside());
  const double for_rim =
      std::max(0.0, time_ratio * all - (all - grouped));  // in particles that are free
  const auto largest =
      static_cast<double>(*std::max_element(grouping.sizes.begin(), grouping.sizes.end()));
  const double whole = static_cast<double>(sizes.min_particles) / largest;
  return all * std::max(whole, rim == 0 ? 0 : std::pow(for_rim / grouped, 3));
}

}  // namespace sinew
