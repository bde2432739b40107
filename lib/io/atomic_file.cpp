// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "core/error.h"

namespace sinew {
namespace {

namespace fs = std::filesystem;

const char* cure_for(int error) {
  if (error == ENOSPC || error == EDQUOT || error == EFBIG)
    return "free some space or choose another place for the results";
  if (error == ENOENT || error == ENOTDIR) return "create its folder first";
  return "choose a place you may write to";
}

Error refused(const fs::path& path, int error) {
  return not_written(path.string(), std::string("cannot be written: ") + std::strerror(error),
                     cure_for(error));
}

Error unreadable(const fs::path& path, int error) {
  return bad_input({path.string()}, std::string("cannot be read: ") + std::strerror(error),
                   "check the path and the permissions");
}

/// A file descriptor that closes itself.
class Descriptor {
 public:
  Descriptor(const fs::path& path, int flags)
      : number_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int number() const { return number_; }
  bool open() const { return number_ >= 0; }
  /// False when the close itself reports that the data did not arrive (network file systems).
  bool close() { return ::close(std::exchange(number_, -1)) == 0; }

 private:
  int number_;
};

bool write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t count = ::write(descriptor, text.data(), text.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return false;
    text.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

void flush(const fs::path& temporary, const fs::path& path) {
  Descriptor file(temporary, O_RDWR);
  if (!file.open() || ::fsync(file.number()) != 0 || !file.close()) throw refused(path, errno);
}

}  // namespace

void replace_file(const fs::path& path, const std::function<void(const fs::path&)>& fill) {
  fs::path temporary = path.parent_path() / ".";
  temporary += path.filename();
  temporary += ".tmp";
  try {
    fill(temporary);
    flush(temporary, path);
    if (::rename(temporary.c_str(), path.c_str()) != 0) throw refused(path, errno);
  } catch (...) {
    ::unlink(temporary.c_str());
    throw;
  }
}

void write_file(const fs::path& path, std::string_view text) {
  replace_file(path, [&](const fs::path& temporary) {
    Descriptor file(temporary, O_WRONLY | O_CREAT | O_TRUNC);
    if (!file.open() || !write_all(file.number(), text) || !file.close())
      throw refused(path, errno);
  });
}

std::string read_file(const fs::path& path, std::uint64_t limit) {
  // Not blocking: a pipe without a writer would hold us at the door for ever.
  Descriptor file(path, O_RDONLY | O_NONBLOCK);
  struct stat status;
  if (!file.open() || ::fstat(file.number(), &status) != 0) throw unreadable(path, errno);
  if (!S_ISREG(status.st_mode))
    throw bad_input({path.string()}, "is not a regular file", "name a file");
  std::string text;
  std::string piece(1 << 16, '\0');
  while (const ssize_t count = ::read(file.number(), piece.data(), piece.size())) {
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw unreadable(path, errno);
    text.append(piece, 0, static_cast<std::size_t>(count));
    if (text.size() > limit)
      throw bad_input({path.string()}, "is larger than " + std::to_string(limit) + " bytes",
                      "check that this is the file you mean");
  }
  return text;
}

}  // namespace sinew
