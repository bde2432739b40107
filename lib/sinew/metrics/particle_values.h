// SPDX-License-Identifier: GPL-3.0-or-later
// The values measured for each particle of a frame, and arrays of them to be written.
//
//     const ParticleValues values = particle_values(rest, state);
//     const std::vector<Column> arrays = particle_arrays(rest, state, names);
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <sinew/core/arrays.h>
#include <sinew/core/dataset.h>
#include <sinew/metrics/frame.h>
#include <sinew/metrics/rest_body.h>

namespace sinew {

/// Lower bound on squared stretches: keeps the logarithm of a singular F finite.
inline constexpr double flattest = 1e-24;

/// n values each, in the written order. From F, the least-squares deformation gradient over the
/// neighbors at rest: not-a-number where those lie in a plane.
struct ParticleValues {
  std::vector<double> displacement;  ///< |x - x0|, m
  std::vector<double> speed;         ///< m/s
  std::vector<double> J;             ///< det F
  std::vector<double> strain;        ///< sqrt(2/3 dev H : dev H), H = ln(F^T F) / 2 (Hencky)
  std::vector<double> stretch;       ///< the largest of U = sqrt(F^T F)
  std::vector<double> D2min;         ///< mean |dx - F dX|^2 over the rest neighbors, m^2
  std::vector<double> neighbors;     ///< closer than b
  std::vector<double> lost;          ///< neighbors at rest that are at b or farther
  std::vector<double> gained;        ///< particles closer than 2.2 r that were not at rest
  std::vector<double> turnover;      ///< (lost + gained) / neighbors at rest
  std::vector<double> pose_error;    ///< |x - q| from the rigid pose of its bone, m
  std::vector<double> weight;        ///< weight of its bone in it; empty where not known
  /// Equivalent of Cauchy's stress (pair_forces.h), Pa; empty where the forces are not known.
  std::vector<double> von_mises;
};

/// In parallel. The state must be one of this body.
ParticleValues particle_values(const RestBody& rest, const FrameState& state);

// Particle values as arrays to be written: tensors in ParaView's order of components, XX YY ZZ XY
// YZ XZ for symmetric ones and row by row for F.

/// Returns those of measured_arrays() that are named, in the written order of the particles;
/// not-a-number where a particle's neighbors do not define them, and stresses where the body's
/// forces are not known. Uses positions and bones of the state. In parallel.
std::vector<Column> particle_arrays(const RestBody& rest, const FrameState& state,
                                    std::span<const std::string_view> names);

/// F, J, strain, stretch, strain_eq, D2min, R and rotation (R of F = R U, row by row, and its
/// angle, degrees) of any points that have moved to `now`: see affine_fit(). In parallel.
std::vector<Column> deformation_arrays(const RestShape& rest, const Points& now);

/// Whether the neighbors of some particle define its deformation.
bool has_strain(const RestBody& rest);

/// The body at rest as a frame, without velocities.
FrameState state_at_rest(const RestBody& rest);

/// Returns those of `asked.measured` that some particle of a state at rest has a value of. Throws
/// bad input, with the reason, for another one unless it is meant by "all".
std::vector<std::string_view> defined_arrays(const RestBody& rest, const FrameState& at_rest,
                                             const RequestedArrays& asked);

}  // namespace sinew
