// SPDX-License-Identifier: GPL-3.0-or-later
// Prepares a state for timing, and the same as input for LAMMPS:
//
//     make_state CONDITION COUNT FOLDER [lammps]
//
// writes FOLDER/SHAPE_COUNT.state, with `lammps` also SHAPE_COUNT.data and eq1.table, and prints
// the parameters of a LAMMPS script as JSON.
#include <cstdio>
#include <cstring>
#include <string>

#include "bench/state_file.h"
#include "lammps_files.h"

namespace {

using namespace sinew;
using namespace sinew::bench;

// LAMMPS is fastest when the table fits into the first cache; the force is then accurate to 1e-4 of
// the largest.
constexpr int table_rows = 1000;
constexpr double table_begin = 0.1;  // d0; no pair of a settled body comes so close

void write_for_lammps(const std::filesystem::path& state, const Scene& scene,
                      const Particles& particles) {
  std::filesystem::path data = state, table = state;
  test::write_lammps_data(data.replace_extension(".data"), particles);
  test::write_lammps_table(table.replace_filename("eq1.table"), scene.body.material.pair,
                           table_begin * 2 * particles.radius, table_rows);
}

void make(Condition condition, std::size_t count, const std::filesystem::path& folder,
          bool lammps) {
  const Scene scene = scene_of(condition, count);
  const Particles particles = settled(scene, condition);
  const auto path = state_path(folder, condition, count);
  write_state(path, particles);
  if (lammps) write_for_lammps(path, scene, particles);
  std::printf("{\"particles\": %zu, \"step\": %.17g, \"d0\": %.17g, \"range\": %.17g}\n",
              particles.size(), scene.step, 2 * particles.radius, scene.body.material.pair.b);
}

}  // namespace

int main(int count, char** words) try {
  if (count != 4 && !(count == 5 && std::strcmp(words[4], "lammps") == 0)) {
    std::fprintf(stderr, "usage: make_state CONDITION COUNT FOLDER [lammps]\n");
    return 2;
  }
  make(condition_named(words[1]), std::stoul(words[2]), words[3], count == 5);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "make_state: %s\n", error.what());
  return 2;
}
