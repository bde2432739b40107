// SPDX-License-Identifier: GPL-3.0-or-later
// Writes the scripts that show a run in ParaView into the run's folder.
//
//     write_view_script("out/bend");
#pragma once

#include <filesystem>

namespace sinew {

/// Writes folder/view.py, for `paraview view.py` and `pvbatch view.py --picture out.png`, and
/// folder/live.py, which follows a run in progress. Throws not written.
void write_view_script(const std::filesystem::path& folder);

}  // namespace sinew
