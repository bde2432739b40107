// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/options.h>

#include <array>

namespace sinew {

namespace {

Vec3 direction(Axis axis) {
  const int index = static_cast<int>(axis) % 3;
  return axis < Axis::minus_x ? Vec3::Unit(index) : Vec3(-Vec3::Unit(index));
}

Mat3 turn_of(Axis up_axis, std::optional<Axis> forward_axis) {
  const Vec3 up = direction(up_axis);
  const Axis after_up = static_cast<Axis>((static_cast<int>(up_axis) + 1) % 3);
  const Vec3 forward = direction(forward_axis.value_or(after_up));
  Mat3 turn;
  turn.row(0) = forward;
  turn.row(1) = up.cross(forward);
  turn.row(2) = up;
  return turn;
}

}  // namespace

Mat3 to_scene(const BodyOptions& body) { return turn_of(body.up, body.forward); }
Mat3 to_scene(const SkeletonOptions& skeleton) { return turn_of(skeleton.up, skeleton.forward); }

double meters(LengthUnit unit) {
  switch (unit) {
    case LengthUnit::m:
      return 1;
    case LengthUnit::dm:
      return 0.1;
    case LengthUnit::cm:
      return 0.01;
    case LengthUnit::mm:
      return 0.001;
    case LengthUnit::um:
      return 1e-6;
    case LengthUnit::inch:
      return 0.0254;
    case LengthUnit::foot:
      return 0.3048;
  }
  return 1;
}

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
