// SPDX-License-Identifier: GPL-3.0-or-later
// Particles and eq. 1 as LAMMPS reads them: a data file and a table.
#pragma once

#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <sinew/core/error.h>
#include <sinew/core/particles.h>
#include <sinew/core/triangles.h>
#include <sinew/material/material.h>

namespace sinew::test {

using TextFile = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

inline TextFile text_file(const std::string& path) {
  TextFile file(std::fopen(path.c_str(), "w"), &std::fclose);
  if (!file) throw not_written(path, "cannot be opened", "choose a folder that may be written");
  return file;
}

/// Positions and velocities for `read_data`, in a box with 2 radii to spare; ids from 1. With
/// `bonds` (pairs of places) for atom_style bond, else atomic.
inline void write_lammps_data(const std::string& path, const Particles& particles,
                              const std::vector<std::array<std::size_t, 2>>& bonds = {}) {
  const TextFile file = text_file(path);
  const Box box = bounds(positions_of(particles));
  const double spare = 2 * particles.radius;
  std::fprintf(file.get(), "particles\n\n%zu atoms\n1 atom types\n", particles.size());
  if (!bonds.empty()) std::fprintf(file.get(), "%zu bonds\n1 bond types\n", bonds.size());
  std::fprintf(file.get(), "\n");
  for (int axis = 0; axis < 3; ++axis)
    std::fprintf(file.get(), "%.17g %.17g %clo %chi\n", box.min()[axis] - spare,
                 box.max()[axis] + spare, 'x' + axis, 'x' + axis);
  std::fprintf(file.get(), "\nMasses\n\n1 %.17g\n\nAtoms\n\n", particles.mass);
  const char* molecule = bonds.empty() ? "" : "1 ";
  for (std::size_t i = 0; i < particles.size(); ++i)
    std::fprintf(file.get(), "%zu %s1 %.17g %.17g %.17g\n", i + 1, molecule, particles.x[i],
                 particles.y[i], particles.z[i]);
  std::fprintf(file.get(), "\nVelocities\n\n");
  for (std::size_t i = 0; i < particles.size(); ++i)
    std::fprintf(file.get(), "%zu %.17g %.17g %.17g\n", i + 1, particles.u[i], particles.v[i],
                 particles.w[i]);
  if (!bonds.empty()) std::fprintf(file.get(), "\nBonds\n\n");
  for (std::size_t k = 0; k < bonds.size(); ++k)
    std::fprintf(file.get(), "%zu 1 %zu %zu\n", k + 1, bonds[k][0] + 1, bonds[k][1] + 1);
}

/// Section EQ1 of `rows` rows from `low` to `high` (m), evenly spaced in r^2, which LAMMPS uses as
/// they are.
inline void write_lammps_table(const std::string& path, const PairForce& pair, double low,
                               double high, int rows) {
  const TextFile file = text_file(path);
  std::fprintf(file.get(), "EQ1\nN %d RSQ %.17g %.17g\n\n", rows, low, high);
  for (int row = 0; row < rows; ++row) {
    const double square = low * low + row * (high * high - low * low) / (rows - 1);
    const double d = std::sqrt(square);
    std::fprintf(file.get(), "%d %.17g %.17g %.17g\n", row + 1, d, pair.potential(d),
                 pair.force(d));
  }
}

}  // namespace sinew::test
