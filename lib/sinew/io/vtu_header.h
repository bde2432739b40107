// SPDX-License-Identifier: GPL-3.0-or-later
// A look at a VTU file before VTK sees it: VTK allocates whatever a file asks for.
#pragma once

#include <filesystem>

namespace sinew {

/// Throws bad input (without the path) when the file is unreadable, is no VTU file, or declares
/// more points, cells or values than its size could hold.
void check_vtu_header(const std::filesystem::path& path);

}  // namespace sinew
