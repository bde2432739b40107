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

/// A file that grows record by record and can be read at any moment. What a program that dies, or a
/// full disk, leaves is a beginning of it.
class GrowingFile {
 public:
  /// Opens the file and keeps the first `kept` bytes of what is there. Throws not written, and bad
  /// input when there are fewer.
  GrowingFile(std::filesystem::path path, std::uint64_t kept);
  ~GrowingFile();
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;

  /// Adds a record: the whole of it or nothing. Throws not written.
  void add(const void* bytes, std::size_t count);
  /// Over what is there, `place` bytes from the beginning. Throws not written.
  void write_at(std::uint64_t place, const void* bytes, std::size_t count);
  void close();  ///< throws not written

 private:
  std::filesystem::path path_;
  int file_ = -1;
  std::uint64_t size_ = 0;
};

/// Waits until all that was written so far on the folder's disk is there even after the machine's
/// power fails, as far as the file system can. Throws not written.
void sync_all(const std::filesystem::path& folder);

/// Writes `text` as the file `path`. Throws not written.
void write_file(const std::filesystem::path& path, std::string_view text);

/// The bytes of a regular file. Throws bad input when it cannot be read or is larger than `limit`.
std::string read_file(const std::filesystem::path& path, std::uint64_t limit = 64 << 20);

}  // namespace sinew
