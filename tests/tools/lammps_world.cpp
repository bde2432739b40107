// SPDX-License-Identifier: GPL-3.0-or-later
// Writes the paper's 2,965 particles, displaced at random, as input for LAMMPS, with eq. 1 as a
// table, and the forces and the energy that we find:
//
//     lammps_world FOLDER A B LAMBDA       (a and b in radii)
//
#include <cstdio>
#include <cstdlib>
#include <string>

#include <sinew/core/cell_grid.h>
#include "support/lammps_files.h"
#include "support/world.h"

namespace sinew {
namespace {

constexpr int rows = 200000;

/// Nearest that a pair comes to a kink of eq. 1, where no table is exact.
double distance_to_kinks(const Points& points, const PairForce& pair) {
  double least = pair.b;
  const NeighborLists lists = neighbors_within(points, 1.01 * pair.b);
  for (std::size_t i = 0; i < points.size(); ++i)
    for (const auto j : lists.of(i))
      for (const double kink : {2 * pair.r, pair.a, pair.b})
        least = std::min(least, std::abs((points[i] - points[j]).norm() - kink));
  return least;
}

/// The box displaced by up to 0.2 r along each axis, without pairs within 1e-5 d0 of a kink.
Particles displaced_box(const Material& material) {
  const double r = material.pair.r;
  for (unsigned seed = 1;; ++seed) {
    const Particles particles =
        test::shaken(test::fcc_box(11, 11, 49, r), material, 0.2 * r, 0, seed);
    if (distance_to_kinks(positions_of(particles), material.pair) > 1e-5 * 2 * r) return particles;
  }
}

void write_forces(const std::string& folder, const Particles& particles, const Material& material) {
  Forces forces;
  pair_forces(particles, material, forces);
  const test::TextFile file = test::text_file(folder + "/ours.txt");
  std::fprintf(file.get(), "%.17g %.17g\n", pair_energy(particles, material.pair), material.pair.b);
  for (const Vec3& force : forces.pair)
    std::fprintf(file.get(), "%.17g %.17g %.17g\n", force.x(), force.y(), force.z());
}

}  // namespace
}  // namespace sinew

int main(int count, char** words) {
  using namespace sinew;
  if (count != 5) return 2;
  Settings settings = test::box_scene();
  settings.material.a = std::atof(words[2]);
  settings.material.b = std::atof(words[3]);
  settings.material.lambda = std::atof(words[4]);
  const Material material = test::material_of(settings);
  const Particles particles = displaced_box(material);
  const std::string folder = words[1];
  test::write_lammps_data(folder + "/box.data", particles);
  test::write_lammps_table(folder + "/eq1.table", material.pair, material.pair.r, material.pair.b,
                           rows);
  write_forces(folder, particles, material);
}
