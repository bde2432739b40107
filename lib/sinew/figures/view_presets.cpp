// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/figures/view_presets.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <vector>

#include <sinew/core/error.h>
#include <sinew/core/text.h>

namespace sinew {
namespace {

constexpr std::array<ViewPreset, 12> all_view_presets = {{
    {"body", View::both, false, deformation, "particles within the skin's edges, and the bones"},
    {"surface", View::surface, false, "displacement",
     "the skin, in color where an array is named, the bones shining through"},
    {"halves", View::halves, false, "strain",
     "half of the skin, beside it the particles, in color"},
    {"cut", View::cut, false, "strain",
     "the volume cut open by a plane, in color; particles where its cells are torn"},
    {"particles", View::particles, false, "displacement", "spheres of their true size"},
    {"section", View::both, true, deformation, "the body cut open along its middle"},
    {"strain", View::particles, false, "strain", "particles by their equivalent strain"},
    {"lines", View::curves, false, "stress",
     "lines along the largest principal stress within the pale skin"},
    {"forces", View::arrows, false, "force_pair", "arrows of a force on the plane of cut"},
    {"bonds", View::lines, false, "strain", "the bonds as lines within the pale skin"},
    {"bones", View::bones, false, "displacement", "the bones and their axes in the pale skin"},
    {"binding", View::binding, false, "displacement",
     "how the bones pull a few particles: reference points, radial and twist forces"},
}};

struct NamedView {
  std::string_view name;
  std::array<double, 3> towards_viewer;
};

constexpr std::array<NamedView, 6> views = {{{"three_quarter", {0.42, -1, 0.36}},
                                             {"front", {0, -1, 0}},
                                             {"back", {0, 1, 0}},
                                             {"left", {-1, 0, 0}},
                                             {"right", {1, 0, 0}},
                                             {"top", {0, 0, 1}}}};

/// The entry of that name in a table, or an error naming what is `wanted`.
template <class Table>
const auto& entry_named(const Table& table, const std::string& name, const char* wanted) {
  std::vector<std::string_view> names;
  for (const auto& entry : table) {
    if (entry.name == name) return entry;
    names.push_back(entry.name);
  }
  throw bad_input("there is no " + std::string(wanted) + ' ' + shown(name),
                  suggestion(name, names));
}

Mat3 view_towards(const Vec3& viewer) {
  const bool upright = std::abs(viewer.x()) + std::abs(viewer.y()) < 1e-6 * std::abs(viewer.z());
  return upright ? view_from_above() : view_from(viewer);
}

}  // namespace

std::span<const ViewPreset> view_presets() { return all_view_presets; }

const ViewPreset& view_preset_named(const std::string& name) {
  return entry_named(all_view_presets, name, "view");
}

ColorMap color_map_named(const std::string& name) {
  return entry_named(color_maps(), name, "color map").map;
}

std::span<const Look> looks() {
  static constexpr std::array<Look, 3> all = {
      {{"screen", "white", 1280, 720, 0, "for screens"},
       {"paper", "white", 2126, 1196, 180,
        "for print: 180 mm wide at 300 dots per inch, beside each PNG an SVG with words and "
        "legends "
        "as vectors"},
       {"dark", "#15181d", 1280, 720, 0, "on a dark background"}}};
  return all;
}

const Look& look_named(const std::string& name) { return entry_named(looks(), name, "look"); }

Backdrop backdrop_named(const std::string& text) {
  if (text == "transparent") return {{}, true};
  if (const auto color = hex_color(text)) return {paper_of(*color), false};
  if (text.starts_with('#'))
    throw bad_input(shown(text) + " is not a color",
                    "give six hexadecimal digits: --background '#f5f5dc'");
  return {paper_of(entry_named(named_colors(), text, "color").color), false};
}

bool is_side(const std::string& text) {
  return text != "top" && std::any_of(std::begin(views), std::end(views),
                                      [&](const auto& view) { return view.name == text; });
}

Mat3 view_named(const std::string& text) {
  Vec3 towards = Vec3::Zero();
  char rest = 0;
  const int read =
      std::sscanf(text.c_str(), "%lf,%lf,%lf%c", &towards.x(), &towards.y(), &towards.z(), &rest);
  if (read <= 0) {
    const auto& [x, y, z] = entry_named(views, text, "camera").towards_viewer;
    return view_towards({x, y, z});
  }
  if (read != 3 || !towards.allFinite() || towards.isZero(0))
    throw bad_input(shown(text) + " is not a camera direction",
                    "give three numbers, not all zero: --camera 1,-2,0.5");
  return view_towards(towards);
}

}  // namespace sinew
