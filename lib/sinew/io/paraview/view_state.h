// SPDX-License-Identifier: GPL-3.0-or-later
// A ParaView state that shows a run: the body cut open (its cells, or else its particles), and its
// bones within the skin. ParaView opens it without its Python, from 5.10 on.
//
//     write_view_state("out/bend", "out/bend/view.pvsm");
#pragma once

#include <filesystem>
#include <string>

#include <sinew/io/paraview/shown_run.h>
#include <sinew/io/paraview/state_file.h>

namespace sinew {

/// The text of the state. Files are named by their absolute paths.
std::string view_state(const ShownRun& run, const ViewOptions& options = {},
                       CameraLinks links = CameraLinks::none);

/// Writes it as `file`, for any version of ParaView, with the run's `ranges` as far as known.
/// Throws bad input where the folder has no frame, and not written.
void write_view_state(const std::filesystem::path& folder, const std::filesystem::path& file,
                      const ValueRanges& ranges = {});

/// Whether there is such a file that view_state() has not written, or that cannot be read.
bool is_foreign_state(const std::filesystem::path& file);

}  // namespace sinew
