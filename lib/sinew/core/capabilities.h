// SPDX-License-Identifier: GPL-3.0-or-later
// What may be combined: one row a feature of a scene or a body, with the features that exclude it.
// Scenes have theirs by settings/read_scene.h, bodies by world/features.h.
//
//     refuse_conflicts(Feature::groups, features_of(body));
#pragma once

#include <algorithm>
#include <functional>
#include <initializer_list>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sinew {

// clang-format off
/// In the order of the table.
enum class Feature {
  cells, lists, single_precision, groups, equilibria, newton, lammps, elements, paper, motion,
  integrator, time_step, residual, static_solver, velocities, preroll, first_pose, bodies, layer, other_packing, hcp,
  modulus_direction, bonds, bonds_alone, k1, nearest_bonds, isotropy, part_stiffness, part_ratio, part_volume, part_density, breaking, yielding, relaxing,
  rayleigh, attraction, one_cohesion, friction, bones, pass_through, open_loop, max_force,
  drag, obstacles, rough_obstacles, mesh_obstacles, pins, fields, muscles, supports_along, pressures, springs,
  branches, oblique_pins, rigid_damping, own_forces, mesh_fields,
  own_law, own_law_of_memory, law_without_precision
};
// clang-format on
using Features = std::set<Feature>;

/// Returns those that are there.
Features features_where(std::initializer_list<std::pair<Feature, bool>> all);

/// Whether any of a list has such a member: neither none nor zero, or a test that holds.
template <class List, class Member>
bool any_has(const List& list, const Member& member) {
  return std::any_of(list.begin(), list.end(),
                     [&](const auto& one) { return static_cast<bool>(std::invoke(member, one)); });
}

struct Exclusion {
  Exclusion(Feature by, std::string_view reason = "") : other(by), why(reason) {}

  Feature other;
  std::string_view why;
};

struct FeatureRow {
  Feature feature;
  std::string_view words;
  std::vector<std::string_view> keys;  ///< settings; none: a program or a command chooses it
  std::vector<Exclusion> excluded_by;
  std::string_view cure;  ///< "": to remove the key; "=word": to set it to that
};
std::span<const FeatureRow> feature_table();

/// A feature that another excludes.
struct Conflict {
  const FeatureRow& feature;
  std::string what, cure;
};

/// The first of the features that `other` excludes.
std::optional<Conflict> conflict_with(Feature other, const Features& features);
/// Throws bad input for it.
void refuse_conflicts(Feature other, const Features& features);

}  // namespace sinew
