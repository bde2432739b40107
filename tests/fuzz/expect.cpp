// SPDX-License-Identifier: GPL-3.0-or-later
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <string>

#include "targets.h"

namespace sinew::fuzz {
namespace {

/// Goes with the process.
struct Folder {
  Folder() {
    const bool in_memory = ::access("/dev/shm", W_OK) == 0;
    std::string name = in_memory ? "/dev/shm/sinew_fuzz_XXXXXX" : "/tmp/sinew_fuzz_XXXXXX";
    path = ::mkdtemp(name.data());
  }
  ~Folder() {
    std::error_code left;
    std::filesystem::remove_all(path, left);
  }
  std::filesystem::path path;
};

}  // namespace

void require(bool holds) {
  if (!holds) std::abort();
}

bool is_one_line(std::string_view text) {
  return std::none_of(text.begin(), text.end(),
                      [](unsigned char c) { return c == '\n' || c == '\r' || c == 0x1b; });
}

std::filesystem::path file_of(std::string_view bytes, const char* name) {
  static const Folder folder;
  const auto path = folder.path / name;
  std::ofstream(path, std::ios::binary | std::ios::trunc)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return path;
}

}  // namespace sinew::fuzz
