// SPDX-License-Identifier: GPL-3.0-or-later
// The table of series: what a run may write, frame by frame. The writer, the folder of a run, its
// readers, the state for ParaView and run.json take their names from there. To write another
// series, add its row in series_table.cpp and what makes it in run/frame_data.cpp.
//
//     for (const std::string_view name : series_in("out/bend")) ...
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/core/dataset.h>

namespace sinew {

/// Version of run.json; increases when a key changes its meaning or is removed.
inline constexpr int run_schema_version = 1;

/// Frames that a series has: each, those with particles (output.every), or those chosen later.
enum class SeriesFrames { every, with_particles, measured };

struct SeriesRow {
  std::string_view name;  ///< NAME.pvd, NAME.vtu.series, NAME/NAME_000000.vtu and so on
  CellKind cells;
  SeriesFrames frames;
  std::string_view asked_by;  ///< the setting or command that asks for it; "": none does
  std::string_view contents;  ///< one line
};

/// In the order in which a frame is written: particles first.
std::span<const SeriesRow> series_table();

/// The row of a series, or nullptr.
const SeriesRow* find_series(std::string_view name);

/// All names, with `between` between them.
std::string series_names(std::string_view between);

/// Names of the series that a folder has.
std::vector<std::string_view> series_in(const std::filesystem::path& folder);

/// "vertex", "line", "triangle" or "tetrahedron".
std::string_view cells_text(CellKind cells);

}  // namespace sinew
