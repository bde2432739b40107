// SPDX-License-Identifier: GPL-3.0-or-later
// What the model itself costs a scene: figures measured on bodies of known shape, for what the
// scene uses, beside its own layers of particles. They are no faults of the scene.
//
//     for (const ModelLimit& limit : model_limits(prepared)) print(limit.key, limit.value);
#pragma once

#include <string>
#include <vector>

#include <sinew/scene/prepare.h>

namespace sinew {

struct ModelLimit {
  std::string key;
  double value = 0;
  std::string text;  ///< what it is a factor on, or a bound of
};

/// crack_energy_factor where bonds break by an energy; bulk_compression_factor where volumes are
/// kept and pressed on; friction_floor where bodies may touch; grip_factor where two supports pull.
std::vector<ModelLimit> model_limits(const Prepared& prepared);

/// How much too stiff a bar is between the layers that two supports hold, which stretch neither
/// outward nor, as surfaces are as stiff as their share of the mesh, inward: N / (N - 2) for N
/// layers; the largest of all pairs, 1 without any. Measured by the strain in the middle of bars of
/// 13, 25 and 49 layers: 1.169, 1.086, 1.042.
double grip_factor(const Body& body);

/// How much more than its bulk modulus says a cube of so many layers is compressed by a pressure
/// all around, for its skin keeps its volume less: by the volume of its particles. For the volume
/// of the skin it is mostly 15 to 60 % too high, and scatters with how the packing lies.
double bulk_compression_factor(double layers, double poisson_ratio);

}  // namespace sinew
