// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-presets: the materials that scenes choose by name, with their sources.
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <string>

#include <sinew/core/options.h>
#include <sinew/core/text.h>
#include "command/command.h"
#include "command/results.h"

namespace {

using namespace sinew;

std::string lines_of(const MaterialPreset& preset) {
  return fmt::format(
      "{}: Young's modulus {}, {} kg/m^3, Poisson's ratio {}, damping ratio {}{}\n  {}; {}\n",
      preset.name, quantity_text(preset.young_modulus, "Pa"), preset.density, preset.poisson_ratio,
      preset.damping_ratio,
      preset.yield_strain ? fmt::format(", yields at a strain of {}", *preset.yield_strain) : "",
      preset.what, preset.source);
}

nlohmann::ordered_json object_of(const MaterialPreset& preset) {
  nlohmann::ordered_json yields;
  if (preset.yield_strain) yields = *preset.yield_strain;
  return {{"name", preset.name},
          {"young_modulus", preset.young_modulus},
          {"density", preset.density},
          {"poisson_ratio", preset.poisson_ratio},
          {"damping_ratio", preset.damping_ratio},
          {"yield_strain", yields},
          {"what", preset.what},
          {"source", preset.source}};
}

Exit list_presets(const Common& common) {
  Results results;
  auto all = nlohmann::ordered_json::array();
  std::string text;
  for (const MaterialPreset& preset : material_presets()) {
    all.push_back(object_of(preset));
    text += lines_of(preset);
  }
  results.add_value("presets", std::move(all));
  print_out(common.json ? results.json() : text);
  return Exit::done;
}

}  // namespace

int main(int argc, char** argv) {
  return run_command(
      argc, argv,
      {"presets",
       "Lists the materials that a scene chooses by name (material.preset), and their sources.",
       {"sinew presets", "sinew presets --json",
        "sinew check configs/box_bend_bvh.yaml --set material.preset=gelatin"},
       false},
      [](OptionList&) {}, list_presets);
}
