// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/world/features.h>

#include <sinew/material/laws.h>
#include <sinew/world/world.h>

namespace sinew {
namespace {

bool is_in_mesh(const ForceField& field) {
  return field.region.shape && std::holds_alternative<MeshShape>(*field.region.shape);
}

Features features_of(const World& world) {
  using enum Feature;
  return features_where({
      {drag, world.drag.rate > 0},
      {obstacles, !world.obstacles.empty()},
      {rough_obstacles,
       any_has(world.obstacles, &Obstacle::friction) || any_has(world.obstacles, &Obstacle::stick)},
      {mesh_obstacles,
       any_has(world.obstacles,
               [](const auto& one) { return std::holds_alternative<MeshShape>(one.shape); })},
      {fields, !world.fields.empty()},
      {own_forces,
       any_has(world.fields,
               [](const auto& one) { return std::holds_alternative<CustomForce>(one.form); })},
      {mesh_fields, any_has(world.fields, is_in_mesh)},
      {muscles, !world.muscles.active.empty()},
      {oblique_pins, any_has(world.pins, &Pinned::is_oblique)},
      {pressures, any_has(world.loads, &Load::pressure)},
      {springs, any_has(world.loads, &Load::stiffness)},
  });
}

}  // namespace

Features features_of(const Body& body) {
  using enum Feature;
  const BondStrength& bond = body.material.bond;
  const ForceLaw& law = law_of(body.material);
  const bool own = law.kernel != nullptr, relaxes = law.has_bonds && bond.branch_count() > 0;
  Features all = features_where({
      {groups, body.grouping != nullptr},
      {paper, !law.has_bonds},
      {part_volume, !body.local.volume.empty()},
      {part_density, !body.density.empty()},
      {breaking, (law.has_bonds && bond.breaking_strain > 0) || !body.local.breaking.empty()},
      {yielding, (law.has_bonds && bond.yield_shear > 0) || !body.local.yield.empty()},
      {relaxing, relaxes},
      {branches, relaxes},
      {friction, body.material.friction > 0},
      {pass_through, body.pass_through.any()},
      {max_force, any_has(body.springs, &BoneSprings::max_force)},
      {rigid_damping, body.rigid_damping != nullptr},
      {own_law, own},
      {own_law_of_memory, own && bonds_change(body.material)},
  });
  if (body.world) all.merge(features_of(*body.world));
  return all;
}

}  // namespace sinew
