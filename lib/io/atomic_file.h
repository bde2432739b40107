// SPDX-License-Identifier: GPL-3.0-or-later
// Files that are there whole or not at all: written beside their place, checked, flushed to the
// disk and renamed, so that no reader ever sees a torn one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace sinew {

/// Calls fill(temporary), which writes that file (same folder, name ".NAME.tmp"), then moves it to
/// `path`. Throws not written when fill does or the disk refuses; the temporary is gone then, and
/// what stood at `path` before is untouched.
void replace_file(const std::filesystem::path& path,
                  const std::function<void(const std::filesystem::path&)>& fill);

/// Writes `text` as the file `path`. Throws not written.
void write_file(const std::filesystem::path& path, std::string_view text);

/// The bytes of a regular file. Throws bad input when it cannot be read or is larger than `limit`.
std::string read_file(const std::filesystem::path& path, std::uint64_t limit = 64 << 20);

}  // namespace sinew
