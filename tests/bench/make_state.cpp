// SPDX-License-Identifier: GPL-3.0-or-later
// Prepares a state for timing, and the same as input for LAMMPS:
//
//     make_state CONDITION COUNT FOLDER [lammps | bonded]
//
// writes FOLDER/SHAPE_COUNT.state, with `lammps` also SHAPE_COUNT.data and eq1.table, and prints
// the parameters of a LAMMPS script as JSON. With `bonded` the body is of bonds: the data file has
// them, and the table is the repulsion of others.
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/core/cell_grid.h>

#include "bench/state_file.h"
#include "support/lammps_files.h"

namespace {

using namespace sinew;
using namespace sinew::bench;

// LAMMPS is fastest when the table fits into the first cache; the force is then accurate to 1e-4 of
// the largest.
constexpr int table_rows = 1000;
constexpr double table_begin = 0.1;  // d0; no pair of a settled body comes so close

std::vector<std::array<std::size_t, 2>> bonds_of(const Scene& scene) {
  std::vector<std::array<std::size_t, 2>> bonds;
  const auto near =
      neighbors_within(scene.body.rest, rest_neighbor_range(scene.body.material.pair.r));
  for (std::size_t i = 0; i < scene.body.rest.size(); ++i)
    for (const std::uint32_t j : near.of(i))
      if (i < j) bonds.push_back({i, j});
  return bonds;
}

void write_for_lammps(const std::filesystem::path& state, const Scene& scene,
                      const Particles& particles, bool bonded) {
  std::filesystem::path data = state, table = state;
  const PairForce& pair = scene.body.material.pair;
  const double d0 = 2 * particles.radius;
  if (bonded)
    test::write_lammps_data(data.replace_extension(".data"), particles, bonds_of(scene));
  else
    test::write_lammps_data(data.replace_extension(".data"), particles);
  test::write_lammps_table(table.replace_filename("eq1.table"), pair, table_begin * d0,
                           bonded ? d0 : pair.b, table_rows);
}

void make(Condition condition, std::size_t count, const std::filesystem::path& folder,
          std::string_view purpose) {
  const bool bonded = purpose == "bonded";
  const Scene scene = scene_of(condition, count, bonded ? Variant::bonded : Variant::paper);
  const Particles particles = settled(scene, condition);
  const auto path = state_path(folder, condition, count);
  write_state(path, particles);
  if (!purpose.empty()) write_for_lammps(path, scene, particles, bonded);
  const Material& material = scene.body.material;
  std::printf(
      "{\"particles\": %zu, \"step\": %.17g, \"d0\": %.17g, \"range\": %.17g, \"stiffness\": "
      "%.17g}\n",
      particles.size(), scene.step, 2 * particles.radius, material.pair.b, material.bond.stiffness);
}

}  // namespace

int main(int count, char** words) try {
  const std::string purpose = count == 5 ? words[4] : "";
  if (count < 4 || count > 5 || (count == 5 && purpose != "lammps" && purpose != "bonded")) {
    std::fprintf(stderr, "usage: make_state CONDITION COUNT FOLDER [lammps | bonded]\n");
    return 2;
  }
  make(condition_named(words[1]), std::stoul(words[2]), words[3], purpose);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "make_state: %s\n", error.what());
  return 2;
}
