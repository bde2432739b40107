// SPDX-License-Identifier: GPL-3.0-or-later
// The script that opens a run in ParaView, left in the run's folder.
#pragma once

#include <filesystem>

namespace sinew {

/// Writes folder/view.py, for `paraview view.py` and `pvbatch view.py --picture out.png`. Throws
/// not written.
void write_view_script(const std::filesystem::path& folder);

}  // namespace sinew
