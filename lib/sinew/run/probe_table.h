// SPDX-License-Identifier: GPL-3.0-or-later
// probes.csv: what parts and points of the body do over time, one row of each per frame.
//
//     ProbeTable table(folder / "probes.csv", setup.probes);
//     table.add(time, positions, rest, {strain, stress, force});
//     table.close();
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <sinew/io/frame_table.h>
#include <sinew/scene/machine.h>

namespace sinew {

/// Values of all particles by id: components XX YY ZZ XY YZ XZ of tensors, not-a-number where they
/// are not known.
struct ProbedValues {
  std::span<const double> strain, stress;  ///< 6 each; Pa
  const Points& force;                     ///< force of the world, N; empty: none
};

/// Young's modulus as a probe shows it: where its mean stress is uniaxial.
struct ShownModulus {
  std::string probe;
  double stress;                ///< the largest principal value by size, Pa
  double strain;                ///< change of length along it over the length at rest
  std::optional<double> asked;  ///< Pa; none where the body's parts differ in modulus

  double young_modulus() const { return stress / strain; }
};

/// The stress along its axis and the strain there, of a mean stress (Cauchy's, Pa) and strain
/// (Green-Lagrange), XX YY ZZ XY YZ XZ, whose other principal stresses are below 5 % of the von
/// Mises stress; none for other stresses, and for strains that are rounding. The strain is the
/// principal one of the same sign: it turns with the body.
std::optional<std::pair<double, double>> uniaxial(std::span<const double, 6> stress,
                                                  std::span<const double, 6> strain);

/// Columns: time (s), name, x, y, z (m, mean place), displacement_x, displacement_y,
/// displacement_z (m), strain_xx to strain_xz (Green-Lagrange), stress_xx to stress_xz (Pa,
/// Cauchy's), force_x, force_y, force_z (N: the sum of all that acts on the part from outside of
/// the body but for its weight; of a point 0). Strains and stresses are means over the particles
/// that have them, and empty where none has.
class ProbeTable {
 public:
  /// Continues after `kept` frames; throws as FrameTable does.
  ProbeTable(const std::filesystem::path& path, std::vector<Probe> probes, std::size_t kept = 0);

  /// Positions and rest by id, m. Throws not written.
  void add(double time, const Points& positions, const Points& rest, const ProbedValues& values);
  void close() { table_.close(); }  ///< throws not written

  /// Names of those of which none of the particles had a strain or a stress in some frame.
  const std::set<std::string>& unknown() const { return unknown_; }

  /// What the frame added last shows of a body.
  std::vector<ShownModulus> moduli(const Body& body) const;

 private:
  using Tensor = std::array<double, 6>;

  std::vector<Probe> probes_;
  FrameTable table_;
  std::set<std::string> unknown_;
  std::vector<std::array<Tensor, 2>> last_;  ///< strain and stress of each probe
};

}  // namespace sinew
