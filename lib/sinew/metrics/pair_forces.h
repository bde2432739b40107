// SPDX-License-Identifier: GPL-3.0-or-later
// What acts between the particles of a frame: bonds, contacts and volumes, and the stress and the
// energy of them.
//
//     const std::vector<Mat3> stress = kirchhoff_stresses(rest, state);
//     const BondValues bonds = bond_values(rest, state);
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <sinew/core/cell_grid.h>
#include <sinew/metrics/frame.h>
#include <sinew/metrics/rest_body.h>

namespace sinew {

/// A particle near another one.
struct Neighbor {
  std::uint32_t index;
  double squared;  ///< distance, m^2
};

/// The particles nearer to i than the range (m), which is that of the grid; in `found`, which grows
/// where it is too short.
std::span<const Neighbor> find_neighbors(const Points& now, const CellGrid& grid, double range,
                                         std::size_t i, std::vector<Neighbor>& found);

/// Whether the body's law and the state determine all forces between particles.
bool knows_forces(const RestBody& rest, const FrameState& state);

/// Kirchhoff's stress of particle i, Pa: -(1/2V) sum f (x) r over all forces between particles,
/// with the stress of its volume and of its muscles. V is the volume at rest that its bonds make
/// stiff (RestBody::volume_share of V0). The forces must be known; `neighbors` are those within b
/// at least.
Mat3 kirchhoff_stress(const RestBody& rest, const FrameState& state,
                      std::span<const Neighbor> neighbors, std::size_t i);

/// Finds it for each particle; not-a-number where the forces are not known. In parallel.
std::vector<Mat3> kirchhoff_stresses(const RestBody& rest, const FrameState& state);

/// Elastic energy of each particle over the same volume V, J/m^3: half of that of its pairs, and
/// that of its volume. Not-a-number where forces or energies are not known. In parallel.
std::vector<double> energy_densities(const RestBody& rest, const FrameState& state);

/// Below this volume ratio a body is crushed flat or folded, and has no true stress.
inline constexpr double min_volume_ratio = 0.05;

/// Cauchy's (true) stress, Pa, of Kirchhoff's and ratio J; not-a-number up to min_volume_ratio.
Mat3 cauchy_stress(const Mat3& kirchhoff, double J);

/// sqrt(3/2 dev s : dev s).
double von_mises(const Mat3& stress);

/// The bonds of a frame, each once: pairs that were neighbors at rest, in the order of their first
/// particle. In the paper's model all of these count as bonds, and as broken from b on.
struct BondValues {
  std::vector<std::array<std::uint32_t, 2>> ends;  ///< particles, the lower first
  std::vector<double> length;                      ///< m
  std::vector<double> strain;  ///< over the rest length, which may have crept; broken: not-a-number
  std::vector<double> force;   ///< N, tension positive; not-a-number where it is not known
  std::vector<std::int32_t> broken;  ///< 0 or 1
};
BondValues bond_values(const RestBody& rest, const FrameState& state);

}  // namespace sinew
