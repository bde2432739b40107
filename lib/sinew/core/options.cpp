// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/options.h>

#include <array>
#include <cmath>

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

Placement placement_of(const BodyOptions& body) {
  return {meters(body.unit) * body.scale, rotation_of(body.rotation) * to_scene(body), body.offset};
}

Placement placement_of(const SkeletonOptions& skeleton) {
  return {skeleton.scale, rotation_of(skeleton.rotation) * to_scene(skeleton), skeleton.offset};
}

namespace {

/// Turns by a multiple of 90 degrees, without rounding.
Mat3 quarter_turns(int axis, double angle) {
  const int x = (axis + 1) % 3, y = (axis + 2) % 3;
  Mat3 quarter = Mat3::Zero();
  quarter(axis, axis) = quarter(y, x) = 1;
  quarter(x, y) = -1;
  Mat3 turn = Mat3::Identity();
  const int quarters = static_cast<int>(std::fmod(angle, 360) / 90) + 4;
  for (int i = 0; i < quarters % 4; ++i) turn = quarter * turn;
  return turn;
}

bool is_right(double angle) { return std::fmod(angle, 90) == 0; }

/// Without the rounding of an angle near a right one.
double without_noise(double angle) {
  const double right = 90 * std::round(angle / 90);
  return std::abs(angle - right) < 1e-9 ? right + 0.0 : angle;
}

}  // namespace

Mat3 rotation_of(const Vec3& angles) {
  if (is_right(angles.x()) && is_right(angles.y()) && is_right(angles.z()))
    return quarter_turns(2, angles.z()) * quarter_turns(1, angles.y()) *
           quarter_turns(0, angles.x());
  const auto about = [&](int axis) {
    return Eigen::AngleAxisd(radians(angles[axis]), Vec3::Unit(axis));
  };
  return (about(2) * about(1) * about(0)).toRotationMatrix();
}

Vec3 angles_of(const Mat3& r) {
  const double across = std::hypot(r(0, 0), r(1, 0));
  Vec3 angles(0, std::atan2(-r(2, 0), across), 0);
  if (across > 1e-12) {
    angles.x() = std::atan2(r(2, 1), r(2, 2));
    angles.z() = std::atan2(r(1, 0), r(0, 0));
  } else {  // z lies along x: only their sum counts
    angles.z() = std::atan2(-r(0, 1), r(1, 1));
  }
  return angles.unaryExpr([](double angle) { return without_noise(degrees(angle)); });
}

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

/// Young's modulus of a rubber by its Shore hardness A, 20 to 80, Pa: A. N. Gent, "On the relation
/// between indentation hardness and Young's modulus", Rubber Chem. Technol. 31 (1958) 896.
constexpr double modulus_of_shore_a(double hardness) {
  return 0.0981e6 * (56 + 7.62336 * hardness) / (0.137505 * (254 - 2.54 * hardness));
}

// Densities of tissues: IT'IS Foundation, Tissue Properties Database 4.1.
constexpr std::array<MaterialPreset, 13> presets = {{
    {"fat", 911, 3250, 0.45, 0.2, std::nullopt, "adipose tissue of the breast",
     "Samani, Zubovits and Plewes, Phys. Med. Biol. 52 (2007) 1565"},
    {"muscle", 1090, 7000, 0.45, 0.2, std::nullopt, "relaxed skeletal muscle",
     "Levinson, Shinagawa and Sato, J. Biomech. 28 (1995) 1145"},
    {"skin", 1109, 420e3, 0.45, 0.2, std::nullopt, "human skin below 30 years",
     "Agache et al., Arch. Dermatol. Res. 269 (1980) 221"},
    {"cartilage", 1100, 5e6, 0.45, 0.2, std::nullopt,
     "cartilage of the knee, loaded for less than its fluid needs to flow",
     "Blankevoort et al., J. Biomech. 24 (1991) 1019"},
    {"bone", 1908, 17e9, 0.3, 0.1, std::nullopt,
     "compact bone of a femur, along its shaft (across it: 11.5 GPa)",
     "Reilly and Burstein, J. Biomech. 8 (1975) 393"},
    {"gelatin", 1020, 15e3, 0.45, 0.1, std::nullopt,
     "ten parts of water to one of powder: a power law from 277 kPa (2 : 1) to 4.34 kPa (20 : 1)",
     "Bonavia et al., arXiv 2512.20502 (2025)"},
    {"natural_rubber", 950, 1.2e6, 0.49, 0.1, std::nullopt,
     "vulcanized, without fillers: three times its shear modulus of 0.39 MPa",
     "Treloar, Trans. Faraday Soc. 40 (1944) 59"},
    {"silicone", 1070, 69e3, 0.45, 0.1, std::nullopt,
     "silicone rubber of Shore hardness 00-30, its modulus at 100 %",
     "Smooth-On, Technical Bulletin Ecoflex Series"},
    {"silicone_20a", 1080, modulus_of_shore_a(20), 0.49, 0.1, std::nullopt,
     "silicone rubber of Shore hardness 20A",
     "Gent, Rubber Chem. Technol. 31 (1958) 896; density: Smooth-On, Dragon Skin 20"},
    {"silicone_40a", 1180, modulus_of_shore_a(40), 0.49, 0.1, std::nullopt,
     "silicone rubber of Shore hardness 40A",
     "Gent, Rubber Chem. Technol. 31 (1958) 896; density: Smooth-On, Smooth-Sil 940"},
    {"silicone_60a", 1250, modulus_of_shore_a(60), 0.49, 0.1, std::nullopt,
     "silicone rubber of Shore hardness 60A",
     "Gent, Rubber Chem. Technol. 31 (1958) 896; density: Smooth-On, Smooth-Sil 960"},
    {"rubber_foam", 48, 72e3, 0.3, 0.1, std::nullopt,
     "open foam of polyurethane, 4 % dense: E = 45 MPa times 0.04^2",
     "Gibson and Ashby, Cellular Solids, 2nd ed. (1997)"},
    {"clay", 1750, 2e6, 0.45, 0.3, 0.007,
     "very soft clay, undrained; yields at twice its shear strength of E / 300",
     "Bowles, Foundation Analysis and Design, 5th ed. (1996)"},
}};
static_assert(presets.size() == static_cast<std::size_t>(MaterialPresetName::clay));

}  // namespace

std::span<const MaterialPreset> material_presets() { return presets; }

const MaterialPreset* preset_named(MaterialPresetName name) {
  const auto place = static_cast<std::size_t>(name);
  return place == 0 ? nullptr : &presets[place - 1];
}

}  // namespace sinew
