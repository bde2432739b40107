// SPDX-License-Identifier: GPL-3.0-or-later
// Materials by name: what material.preset stands for, each with its source.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "core/settings.h"

namespace sinew {

struct MaterialPreset {
  MaterialPresetName name;
  double density;        ///< kg/m^3
  double young_modulus;  ///< Pa
  double poisson_ratio;  ///< within what bonded_volume reaches
  double damping_ratio;  ///< of the first bending: our choice, such bodies swing once or twice
  std::optional<double> yield_strain;  ///< of one that flows
  std::string_view what, source;
};

/// In the order of the names, without none.
std::span<const MaterialPreset> material_presets();

/// nullptr for none.
const MaterialPreset* preset_named(MaterialPresetName name);

}  // namespace sinew
