// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/material_presets.h"

#include <array>

namespace sinew {
namespace {

// Densities of tissues: IT'IS Foundation, Tissue Properties Database 4.1.
constexpr std::array<MaterialPreset, 6> presets = {{
    {MaterialPresetName::fat, 911, 3250, 0.45, 0.2, std::nullopt, "adipose tissue of the breast",
     "Samani, Zubovits and Plewes, Phys. Med. Biol. 52 (2007) 1565"},
    {MaterialPresetName::muscle, 1090, 7000, 0.45, 0.2, std::nullopt, "relaxed skeletal muscle",
     "Levinson, Shinagawa and Sato, J. Biomech. 28 (1995) 1145"},
    {MaterialPresetName::skin, 1109, 420e3, 0.45, 0.2, std::nullopt, "human skin below 30 years",
     "Agache et al., Arch. Dermatol. Res. 269 (1980) 221"},
    {MaterialPresetName::silicone, 1070, 69e3, 0.45, 0.1, std::nullopt,
     "silicone rubber of Shore hardness 00-30, its modulus at 100 %",
     "Smooth-On, Technical Bulletin Ecoflex Series"},
    {MaterialPresetName::rubber_foam, 48, 72e3, 0.3, 0.1, std::nullopt,
     "open foam of polyurethane, 4 % dense: E = 45 MPa times 0.04^2",
     "Gibson and Ashby, Cellular Solids, 2nd ed. (1997)"},
    {MaterialPresetName::clay, 1750, 2e6, 0.45, 0.3, 0.007,
     "very soft clay, undrained; yields at twice its shear strength of E / 300",
     "Bowles, Foundation Analysis and Design, 5th ed. (1996)"},
}};

}  // namespace

std::span<const MaterialPreset> material_presets() { return presets; }

const MaterialPreset* preset_named(MaterialPresetName name) {
  for (const MaterialPreset& preset : presets)
    if (preset.name == name) return &preset;
  return nullptr;
}

}  // namespace sinew
