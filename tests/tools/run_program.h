// SPDX-License-Identifier: GPL-3.0-or-later
// Runs a program as a user does, and keeps what it says.
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

#include "support/temp_folder.h"

namespace sinew {

struct Ran {
  int exit;
  std::string out, err;
};

inline std::string content(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// Runs a line of shell.
inline Ran run(const std::string& line) {
  const TempFolder folder;
  const auto out = folder.path() / "out", err = folder.path() / "err";
  const std::string all = "( " + line + " ) >" + out.string() + " 2>" + err.string();
  const int status = std::system(all.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content(out), content(err)};
}

}  // namespace sinew
