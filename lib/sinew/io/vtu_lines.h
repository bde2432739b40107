// SPDX-License-Identifier: GPL-3.0-or-later
// VTU files as write_vtu leaves them, a line per tag and per array: read several times sooner than
// by a reader that knows all of XML.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <optional>

#include <sinew/core/dataset.h>

namespace sinew {

/// What the file holds, of its points' arrays only those in `names` if given: nothing where the
/// file is not just as write_vtu writes it with data in its elements, or damaged.
std::optional<Dataset> read_vtu_lines(
    const std::filesystem::path& path,
    const std::optional<std::initializer_list<const char*>>& names);

}  // namespace sinew
