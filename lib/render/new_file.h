// SPDX-License-Identifier: GPL-3.0-or-later
// A file that appears under its name only once it is complete: written beside its place, renamed.
#pragma once

#include <cstddef>
#include <string>

namespace sinew {

class NewFile {
 public:
  /// Creates the temporary file. Throws not written where that is impossible.
  explicit NewFile(std::string path);
  ~NewFile();  ///< removes the temporary file if it was not finished
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  const std::string& temporary() const { return temporary_; }
  void write(const void* bytes, std::size_t count);  ///< throws not written
  void finish();                                     ///< puts it in place; throws not written

 private:
  [[noreturn]] void fail(const std::string& what) const;

  std::string path_, temporary_;
  int file_ = -1;
};

}  // namespace sinew
