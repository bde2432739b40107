// SPDX-License-Identifier: GPL-3.0-or-later
// Writes the paper's 2,965 particles, displaced at random, as input for LAMMPS, with eq. 1 as a
// table, and the forces and the energy that we find:
//
//     lammps_world FOLDER A B LAMBDA       (a and b in radii)
//
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

#include "core/neighbours.h"
#include "world.h"

namespace sinew {
namespace {

constexpr int rows = 200000;

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

File open(const std::string& folder, const char* name) {
  File file(std::fopen((folder + '/' + name).c_str(), "w"), &std::fclose);
  if (!file) std::exit(1);
  return file;
}

/// Nearest that a pair comes to a kink of eq. 1, where no table is exact.
double distance_to_kinks(const Points& points, const PairForce& pair) {
  double least = pair.b;
  const NeighbourLists lists = neighbours_within(points, 1.01 * pair.b);
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

void write_data(const std::string& folder, const Particles& particles) {
  const File file = open(folder, "box.data");
  std::fprintf(file.get(), "box\n\n%zu atoms\n1 atom types\n\n", particles.size());
  for (const char axis : {'x', 'y', 'z'}) std::fprintf(file.get(), "-1 1 %clo %chi\n", axis, axis);
  std::fprintf(file.get(), "\nMasses\n\n1 %.17g\n\nAtoms\n\n", particles.mass);
  for (std::size_t i = 0; i < particles.size(); ++i)
    std::fprintf(file.get(), "%zu 1 %.17g %.17g %.17g\n", i + 1, particles.x[i], particles.y[i],
                 particles.z[i]);
}

/// Rows evenly spaced in r^2, which LAMMPS uses as they are.
void write_table(const std::string& folder, const PairForce& pair) {
  const File file = open(folder, "eq1.table");
  const double low = pair.r, high = pair.b;
  std::fprintf(file.get(), "EQ1\nN %d RSQ %.17g %.17g\n\n", rows, low, high);
  for (int row = 0; row < rows; ++row) {
    const double square = low * low + row * (high * high - low * low) / (rows - 1);
    const double d = std::sqrt(square);
    std::fprintf(file.get(), "%d %.17g %.17g %.17g\n", row + 1, d, pair.potential(d),
                 pair.force(d));
  }
}

void write_forces(const std::string& folder, const Particles& particles, const Material& material) {
  Forces forces;
  pair_forces(particles, material, forces);
  const File file = open(folder, "ours.txt");
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
  write_data(words[1], particles);
  write_table(words[1], material.pair);
  write_forces(words[1], particles, material);
}
