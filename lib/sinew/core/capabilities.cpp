// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/capabilities.h>

#include <sinew/core/error.h>

namespace sinew {
namespace capabilities {  // whose names are short
namespace {

using enum Feature;

FeatureRow row(Feature feature, std::string_view words, std::vector<std::string_view> keys,
               std::vector<Exclusion> excluded_by, std::string_view cure = "") {
  return {feature, words, std::move(keys), std::move(excluded_by), cure};
}

constexpr auto loads_alone = "supports and loads act on them";
constexpr auto no_volume = "that of bonds alone is 1/4";
constexpr auto no_bonds = "it has no bonds";
constexpr auto of_each = "it acts on each particle within them";

const std::vector<FeatureRow> table = {
    row(cells, "the paper's cells", {"solver.neighbor_search"}, {equilibria, groups, lammps},
        "=lists"),
    row(lists, "lists of neighbors", {}, {}),
    row(single_precision, "single precision", {"solver.precision"},
        {{newton, "rounding hides the tangent"}, lammps}, "=double"),
    row(groups, "groups of particles", {"hierarchy.enabled"},
        {{equilibria, "they are of free particles"}, lammps}, "=false"),
    row(equilibria, "equilibria", {"solver.method"}, {lammps}, "=dynamic"),
    row(newton, "Newton's method", {"solver.static_solver"}, {}, "=auto or relaxation"),
    row(lammps, "engine lammps", {}, {}, "run without --engine"),
    row(elements, "finite elements", {}, {}, "use sinew simulate"),
    row(paper, "the paper's model", {"material.model"},
        {{newton, "bodies without bonds flow"}, {elements, "it flows"}},
        "=bonded or bonded_volume"),
    row(motion, "motion in time", {"solver.method"}, {}, "=static"),
    row(integrator, "a choice of integrator", {"solver.integrator"}, {equilibria}),
    row(time_step, "a time step", {"solver.time_step"}, {equilibria}),
    row(residual, "a residual", {"solver.residual"}, {motion}),
    row(static_solver, "a solver of equilibria", {"solver.static_solver"}, {motion}),
    row(velocities, "initial velocities", {"body.velocity", "body.angular_velocity", "bodies"},
        {equilibria}),
    row(preroll, "a preroll", {"motion.preroll"}, {{first_pose, "it has no way there"}}),
    row(first_pose, "a first pose", {"motion.begin"}, {equilibria, groups}, "=rest"),
    row(bodies, "several bodies", {"bodies"}, {elements}, "join the meshes into one"),
    row(layer, "a layer on a surface", {"body.thickness"}, {elements}, "give a closed mesh"),
    row(other_packing, "packings other than fcc", {"body.packing"},
        {{groups, "only in fcc are particles centers of their neighbors"}}, "=fcc"),
    row(hcp, "hcp", {"body.packing"}, {}, "=fcc"),
    row(modulus_direction, "moduli along a direction", {"material.modulus_direction"},
        {other_packing}),
    row(bonds, "bonded models", {"material.model"}, {}, "=paper"),
    row(bonds_alone, "bonds alone", {"material.model"}, {}, "=bonded_volume"),
    row(k1, "one stiffness of all", {"material.k1"}, {}, "give material.young_modulus instead"),
    row(nearest_bonds, "bonds of nearest neighbors alone", {"material.isotropic"},
        {{elements, "they are isotropic"}}, "use a bonded material.model in fcc"),
    row(isotropy, "isotropy", {"material.isotropic"}, {{paper, no_bonds}, hcp}),
    row(part_stiffness, "parts of other stiffness", {"materials", "bodies"}, {nearest_bonds, k1}),
    row(part_ratio, "parts of other Poisson's ratio", {"materials"},
        {{paper, no_volume}, {bonds_alone, no_volume}}, "leave poisson_ratio out"),
    row(part_volume, "parts of other bulk modulus", {"materials", "bodies"}, {lammps}),
    row(part_density, "parts of other density", {"materials"}, {groups, lammps},
        "leave density out"),
    row(breaking, "bonds that break",
        {"material.breaking_strain", "material.fracture_energy", "materials"},
        {{paper, no_bonds}, groups, newton, lammps, elements}),
    row(yielding, "bonds that creep", {"material.yield_strain", "materials"},
        {{paper, no_bonds}, groups, newton, lammps, elements}),
    row(relaxing, "bonds that relax", {"material.relaxation_shares", "material.relaxation_times"},
        {{paper, no_bonds}, groups, lammps}),
    row(rayleigh, "Rayleigh's damping", {"material.rayleigh"}, {groups}),
    row(attraction, "attraction of all", {"material.cohesion"}, {}, "=initial_neighbors"),
    row(one_cohesion, "a choice of cohesion", {"material.cohesion"},
        {{bonds, "they attract through their bonds alone"}}),
    row(friction, "friction of a body on itself", {"material.friction"},
        {{attraction, "parts that touch do not slide"},
         {equilibria, "it has no one equilibrium"},
         {groups, "those that touch do not rub"},
         newton,
         lammps}),
    row(bones, "bones", {"skeleton"}, {{elements, "supports hold them"}}),
    row(pass_through, "flesh that passes through flesh", {"contact.pass_through"},
        {groups, newton, lammps}),
    row(open_loop, "the twist of open_loop", {"binding.twist_form"},
        {{equilibria, "nothing balances it"}}, "=servo"),
    row(max_force, "bones whose holds yield", {"binding.max_force"},
        {{open_loop, "it stores no energy"}, groups, newton, lammps}),
    row(drag, "drag", {"world.drag"}, {{groups, of_each}}),
    row(obstacles, "obstacles", {"world.obstacles"}, {{elements, loads_alone}}),
    row(rough_obstacles, "obstacles that rub", {"world.obstacles"}, {newton}, "leave friction out"),
    row(mesh_obstacles, "obstacles of meshes", {"world.obstacles"}, {lammps},
        "choose another shape"),
    row(pins, "pins", {"world.pins"}, {{elements, loads_alone}}),
    row(fields, "fields", {"world.fields"}, {{groups, of_each}, {elements, loads_alone}}),
    row(muscles, "muscles", {"world.muscles"}, {lammps, {elements, loads_alone}}),
    row(supports_along, "supports along a direction", {"supports"}, {elements},
        "hold axes of the scene"),
    row(pressures, "pressures", {"loads"}, {{newton, "they follow the surface"}, lammps},
        "give forces instead"),
    row(springs, "springs", {"world.springs"},
        {{newton, "they follow the body"}, lammps, {elements, loads_alone}}),
    row(branches, "branches of bonds, which relax in time", {}, {newton}),
    row(oblique_pins, "oblique rollers", {}, {newton}),
    row(rigid_damping, "damping relative to holds", {}, {lammps},
        "set material.damping_form to central"),
    row(own_forces, "forces of one's own", {}, {lammps}),
    row(mesh_fields, "fields in meshes", {}, {lammps}),
    row(own_law, "a law that a program brings", {}, {groups, newton, lammps}),
    row(own_law_of_memory, "a program's law with bonds that change", {}, {lists},
        "leave out strength and relaxation"),
    row(law_without_precision, "a law without steps in this precision", {}, {lists},
        "use the other one"),
};

}  // namespace
}  // namespace capabilities

namespace {

using capabilities::table;

/// How to do without a feature.
std::string cure_of(const FeatureRow& row) {
  const std::string key(row.keys.size() == 1 ? row.keys.front() : "");
  if (row.cure.starts_with('=')) return ("set " + key + " to ").append(row.cure.substr(1));
  if (!row.cure.empty()) return std::string(row.cure);
  return key.empty() ? "leave it out" : "remove " + key;
}

}  // namespace

std::span<const FeatureRow> feature_table() { return table; }

Features features_where(std::initializer_list<std::pair<Feature, bool>> all) {
  Features there;
  for (const auto& [feature, is_there] : all)
    if (is_there) there.insert(feature);
  return there;
}

std::optional<Conflict> conflict_with(Feature other, const Features& features) {
  const FeatureRow& with = table[static_cast<std::size_t>(other)];
  for (const Feature feature : features) {
    const FeatureRow& row = table[static_cast<std::size_t>(feature)];
    for (const Exclusion& by : row.excluded_by) {
      if (by.other != other) continue;
      std::string what(row.words);
      (what += " and ").append(with.words) += " exclude each other";
      if (!by.why.empty()) (what += ": ").append(by.why);
      return Conflict{row, what, cure_of(row) + ", or " + cure_of(with)};
    }
  }
  return {};
}

void refuse_conflicts(Feature other, const Features& features) {
  if (const auto conflict = conflict_with(other, features))
    throw bad_input(conflict->what, conflict->cure);
}

}  // namespace sinew
