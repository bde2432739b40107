// SPDX-License-Identifier: GPL-3.0-or-later
#include "config/checks.h"

#include <array>
#include <string>

#include "core/settings_table.h"

namespace sinew {
namespace {

/// Whether the scene gives this key a value (auto is none).
bool is_given(const Settings& settings, std::string_view path) {
  if (settings.places.find(path) == settings.places.end()) return false;
  for (const auto& row : settings_table())
    if (std::string(row.section) + '.' + std::string(row.name) == path)
      return !std::holds_alternative<std::monostate>(row.get(settings));
  return false;
}

void check_pair(const Settings& settings, const EitherOr& pair) {
  const bool first = is_given(settings, pair.first), second = is_given(settings, pair.second);
  const std::string names = std::string(pair.first) + " and " + std::string(pair.second);
  if (first && second)
    throw bad_input(settings.place(std::string(pair.second)), names + " are both given",
                    "keep one of them");
  if (pair.needed && !first && !second)
    throw bad_input(settings.place(std::string(pair.first)), names + " are both missing",
                    "give one of them");
}

/// The place of the first of two keys that the scene gives.
Place place_of(const Settings& settings, const char* first, const char* second) {
  return settings.place(is_given(settings, first) ? first : second);
}

void check_axes(const Settings& settings) {
  if (to_scene(settings.skeleton).determinant() < 0.5)
    throw bad_input(place_of(settings, "skeleton.forward", "skeleton.up"),
                    "up and forward of the rig lie along one axis",
                    "name two different axes, as in up: y and forward: z");
}

void check_clip(const Settings& settings) {
  const MotionSettings& motion = settings.motion;
  if (motion.end && !(*motion.end > motion.start))
    throw bad_input(place_of(settings, "motion.end", "motion.start"),
                    "the clip would end at " + number_text(*motion.end) +
                        " s before it begins at " + number_text(motion.start) + " s",
                    "give an end after motion.start");
}

}  // namespace

std::span<const EitherOr> either_or() {
  static constexpr std::array<EitherOr, 3> pairs = {{
      {"body.radius", "body.count", true},
      {"material.young_modulus", "material.k1", false},
      {"material.lambda", "material.k2", false},
  }};
  return pairs;
}

std::string_view rival_of(std::string_view path) {
  for (const EitherOr& pair : either_or()) {
    if (pair.first == path) return pair.second;
    if (pair.second == path) return pair.first;
  }
  return "";
}

void check_together(const Settings& settings) {
  for (const EitherOr& pair : either_or()) check_pair(settings, pair);
  const MaterialSettings& material = settings.material;
  if (!(material.a < material.b))
    throw bad_input(place_of(settings, "material.a", "material.b"),
                    "attraction would end at b = " + number_text(material.b) +
                        " radii before it begins at a = " + number_text(material.a),
                    "give an a below b");
  check_axes(settings);
  check_clip(settings);
  const double duration = settings.solver.duration, interval = settings.output.interval;
  if (duration > 0 && interval > duration)
    throw bad_input(
        place_of(settings, "output.interval", "solver.duration"),
        "frames every " + number_text(interval) + " s in a run of " + number_text(duration) + " s",
        "give output.interval a value up to solver.duration");
}

}  // namespace sinew
