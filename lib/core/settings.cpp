// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/settings.h"

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

Mat3 to_scene(const BodySettings& body) { return turn_of(body.up, body.forward); }
Mat3 to_scene(const SkeletonSettings& skeleton) { return turn_of(skeleton.up, skeleton.forward); }

double metres(LengthUnit unit) {
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

Place Settings::place(std::string path) const {
  while (true) {
    if (const auto found = places.find(path); found != places.end()) return found->second;
    const auto cut = path.find_last_of(".[");
    if (cut == std::string::npos) break;
    path.resize(cut);
  }
  const auto scene = places.find("");
  return scene == places.end() ? Place{} : scene->second;
}

}  // namespace sinew
