// SPDX-License-Identifier: GPL-3.0-or-later
// The scripts that show a run in ParaView, left in the run's folder.
#pragma once

#include <filesystem>

namespace sinew {

/// Writes folder/view.py, for `paraview view.py` and `pvbatch view.py --picture out.png`, and
/// folder/live.py, which follows a run that is still going. Throws not written.
void write_view_script(const std::filesystem::path& folder);

}  // namespace sinew
