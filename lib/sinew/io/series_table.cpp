// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/series_table.h>

#include <algorithm>
#include <array>
#include <system_error>

#include <sinew/io/series.h>

namespace sinew {
namespace {

constexpr SeriesFrames each = SeriesFrames::every, thinned = SeriesFrames::with_particles;

constexpr auto all_series = std::to_array<SeriesRow>({
    {"particles", CellKind::vertex, thinned, "", "the particles"},
    {"surface", CellKind::triangle, each, "", "the surface of the body, as its particles move it"},
    {"bones", CellKind::line, each, "", "bones and their axes as lines"},
    {"frames", CellKind::vertex, each, "", "a point for the head of every bone"},
    {"obstacles", CellKind::triangle, each, "", "the obstacles, if the scene has any"},
    {"supports", CellKind::vertex, each, "",
     "a point for every support and load, in the middle of its part: force, moment, power and "
     "displacement"},
    {"bonds", CellKind::line, thinned, "output.bonds", "the bonds between particles as lines"},
    {"volume", CellKind::tetrahedron, thinned, "output.volume",
     "the body as tetrahedra between its particles, up to the surface of the mesh"},
    {"skin_lbs", CellKind::triangle, each, "output.skin_lbs",
     "the surface moved by linear-blend skinning alone"},
    {"skin_dqs", CellKind::triangle, each, "output.skin_dqs",
     "the surface moved by dual-quaternion skinning alone"},
    {"values", CellKind::vertex, SeriesFrames::measured, "sinew measure --arrays",
     "arrays of the particles measured later"},
});

}  // namespace

std::span<const SeriesRow> series_table() { return all_series; }

const SeriesRow* find_series(std::string_view name) {
  const auto* row = std::find_if(all_series.begin(), all_series.end(),
                                 [&](const SeriesRow& one) { return one.name == name; });
  return row == all_series.end() ? nullptr : row;
}

std::string series_names(std::string_view between) {
  std::string names;
  for (const SeriesRow& row : all_series)
    names.append(names.empty() ? "" : between).append(row.name);
  return names;
}

std::vector<std::string_view> series_in(const std::filesystem::path& folder) {
  std::vector<std::string_view> names;
  std::error_code unreachable;
  for (const SeriesRow& row : all_series)
    if (std::filesystem::is_regular_file(folder / series_files(std::string(row.name))[0],
                                         unreachable))
      names.push_back(row.name);
  return names;
}

std::string_view cells_text(CellKind cells) {
  static constexpr std::array<std::string_view, 4> names = {"vertex", "line", "triangle",
                                                            "tetrahedron"};
  return names[static_cast<std::size_t>(cells) - 1];
}

}  // namespace sinew
