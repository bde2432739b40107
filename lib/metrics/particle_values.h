// SPDX-License-Identifier: GPL-3.0-or-later
// What is measured of every single particle of a frame.
#pragma once

#include <vector>

#include "metrics/body.h"
#include "metrics/frame.h"

namespace sinew {

/// n values each, in the written order. From F, the least-squares deformation gradient over the
/// neighbours at rest: not-a-number where those lie in a plane.
struct ParticleValues {
  std::vector<double> displacement;  ///< |x - x0|, m
  std::vector<double> speed;         ///< m/s
  std::vector<double> J;             ///< det F
  std::vector<double> strain;        ///< sqrt(2/3 dev H : dev H), H = ln(F^T F) / 2 (Hencky)
  std::vector<double> stretch;       ///< the largest of U = sqrt(F^T F)
  std::vector<double> D2min;         ///< mean |dx - F dX|^2 over the rest neighbours, m^2
  std::vector<double> neighbours;    ///< closer than b
  std::vector<double> near;          ///< closer than 2.2 r
  /// sqrt(3/2 dev s : dev s) of the virial stress s = -(1/2V0) sum f (x) r, Pa; empty where the
  /// body's pair force is not known.
  std::vector<double> von_mises;
};

/// In parallel. The state is one of this body.
ParticleValues particle_values(const RestBody& rest, const FrameState& state);

}  // namespace sinew
