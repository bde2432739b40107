// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/new_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "core/error.h"

namespace sinew {

NewFile::NewFile(std::string path)
    : path_(std::move(path)), temporary_(path_ + "." + std::to_string(getpid()) + ".part") {
  file_ = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file_ < 0) fail("cannot be created");
}

NewFile::~NewFile() {
  if (file_ < 0) return;
  close(file_);
  unlink(temporary_.c_str());
}

void NewFile::write(const void* bytes, std::size_t count) {
  const char* next = static_cast<const char*>(bytes);
  while (count > 0) {
    const ssize_t written = ::write(file_, next, count);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("cannot be written");
    next += written;
    count -= static_cast<std::size_t>(written);
  }
}

void NewFile::finish() {
  if (fsync(file_) != 0 || std::rename(temporary_.c_str(), path_.c_str()) != 0)
    fail("cannot be written");
  close(file_);
  file_ = -1;
}

void NewFile::fail(const std::string& what) const {
  throw not_written(path_, what + " (" + std::strerror(errno) + ")",
                    "choose a folder that exists, is yours to write, and has space left");
}

}  // namespace sinew
