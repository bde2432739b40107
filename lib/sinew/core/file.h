// SPDX-License-Identifier: GPL-3.0-or-later
// Files that appear atomically: written beside their place, checked and renamed, so that no reader
// ever sees an incomplete one and a program that dies leaves the older one untouched. All files and
// folders that the library makes come from here: nothing is written through a link that stands in
// the place of a file, or of a folder within one that sinew made.
//
//     NewFile file("run/summary.json");
//     file.write(text.data(), text.size()), file.finish();
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace sinew {

/// Whether a finished file survives a power failure.
enum class Durability { cached, synced };

/// A file in preparation. Without finish() it is removed.
class NewFile {
 public:
  /// Creates the temporary file, ".NAME.tmp" in the same folder. Throws not written.
  explicit NewFile(std::filesystem::path path);
  ~NewFile();
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  /// Where to write: with write(), or through this name.
  const std::filesystem::path& temporary() const { return temporary_; }
  int descriptor() const { return file_; }
  void write(const void* bytes, std::size_t count);  ///< at the end; throws not written
  /// Makes the file longer by `count` bytes, which write_at() then fills; where they begin.
  std::uint64_t extend(std::uint64_t count);
  /// Writes at `place`, also from several threads. Throws not written.
  void write_at(std::uint64_t place, const void* bytes, std::size_t count) const;
  /// Moves it to its place. Throws not written.
  void finish(Durability durability = Durability::cached);

 private:
  std::filesystem::path path_, temporary_;
  int file_ = -1;
  std::uint64_t size_ = 0;
};

// A file that several processes write, each a part, and that appears atomically as well.

/// Writes `bytes` at `place` of the temporary file of `path`. Who writes the beginning, at 0,
/// creates it; only then come the others. Throws not written.
void write_part(const std::filesystem::path& path, std::uint64_t place, std::string_view bytes);
/// Adds the last part behind all others and moves the file to its place. Throws not written.
void finish_parts(const std::filesystem::path& path, std::string_view last);

/// A file that grows record by record and can be read at any moment. If the program dies or the
/// disk fills up, what is left is a prefix of it.
class GrowingFile {
 public:
  /// Opens the file and keeps the first `kept` bytes of it; other names that it has keep what they
  /// name. Throws not written, and bad input when it has fewer.
  GrowingFile(std::filesystem::path path, std::uint64_t kept);
  ~GrowingFile();
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;

  /// Appends a record atomically. Throws not written.
  void add(const void* bytes, std::size_t count);
  /// Overwrites what is `place` bytes from the beginning. Throws not written.
  void write_at(std::uint64_t place, const void* bytes, std::size_t count);
  void close();  ///< throws not written

 private:
  std::filesystem::path path_;
  int file_ = -1;
  std::uint64_t size_ = 0;
};

/// Descriptor, to be closed by the caller, of a new empty file in the place of whatever file or
/// link was there; -1, with errno, when it cannot be made.
int create_file(const std::filesystem::path& path);

/// Descriptor, to be closed by the caller, of a file to be locked, made when it is missing; -1,
/// with errno, when it cannot be opened, is a link or has a second name.
int open_lock(const std::filesystem::path& path);

/// Creates a folder and those above it. Throws not written.
void create_folder(const std::filesystem::path& folder);

/// Creates a folder within one that sinew made. Throws not written, and bad input when a link to
/// another folder is in its place.
void create_inner_folder(const std::filesystem::path& folder);

/// Throws bad input when the folder is a link, through which files elsewhere would be replaced.
void refuse_link(const std::filesystem::path& folder);

/// Waits until everything written so far to the folder's disk survives a power failure, as far as
/// the file system can guarantee it. Throws not written.
void sync_all(const std::filesystem::path& folder);

/// Writes `text` as the file `path`. Throws not written.
void write_file(const std::filesystem::path& path, std::string_view text);

/// Whether a path leads to its folder or below, links apart.
bool stays_below(const std::filesystem::path& path);

/// The file `name` in `folder` or below it, where links do not lead elsewhere either; "" otherwise.
/// Files that another file names are copied into results: one from elsewhere must not name others.
std::filesystem::path file_below(const std::filesystem::path& folder,
                                 const std::filesystem::path& name);

/// The bytes of a regular file. Throws bad input when it cannot be read or is larger than `limit`.
std::string read_file(const std::filesystem::path& path, std::uint64_t limit = 64 << 20);

/// Calls visit(piece) for the bytes of a regular file of any size, piece by piece. Throws bad input
/// when it cannot be read.
void read_through(const std::filesystem::path& path,
                  const std::function<void(std::string_view)>& visit);

/// The first bytes of a regular file, `most` or as many as it has. Throws bad input when it cannot
/// be read.
std::string read_head(const std::filesystem::path& path, std::uint64_t most);

}  // namespace sinew
