// SPDX-License-Identifier: GPL-3.0-or-later
// Files that are there whole or not at all: written beside their place, checked and renamed, so
// that no reader ever sees a torn one and a program that dies leaves the older one untouched.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace sinew {

/// Whether a finished file is there even after the machine's power fails.
enum class Durability { cached, synced };

/// A file in the making. What is not finished disappears.
class NewFile {
 public:
  /// Creates the temporary file, ".NAME.tmp" in the same folder. Throws not written.
  explicit NewFile(std::filesystem::path path);
  ~NewFile();
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  /// Where to write: by write(), or by others under this name.
  const std::filesystem::path& temporary() const { return temporary_; }
  void write(const void* bytes, std::size_t count);  ///< throws not written
  /// Puts it in place. Throws not written.
  void finish(Durability durability = Durability::cached);

 private:
  std::filesystem::path path_, temporary_;
  int file_ = -1;
};

/// Writes `text` as the file `path`. Throws not written.
void write_file(const std::filesystem::path& path, std::string_view text);

/// The bytes of a regular file. Throws bad input when it cannot be read or is larger than `limit`.
std::string read_file(const std::filesystem::path& path, std::uint64_t limit = 64 << 20);

}  // namespace sinew
