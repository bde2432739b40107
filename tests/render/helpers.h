// SPDX-License-Identifier: GPL-3.0-or-later
// What the tests of pictures share.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <string>

#include <sinew/core/error.h>
#include <sinew/render/image.h>

#include "support/temp_folder.h"

namespace sinew {

/// An empty folder that goes away with this value.
class Folder {
 public:
  std::string file(const std::string& name) const { return (own_.path() / name).string(); }
  bool empty() const { return std::filesystem::is_empty(own_.path()); }

 private:
  TempFolder own_;
};

/// Runs a command in the shell; its exit code, and what it printed in `output` when given.
int run(const std::string& command, std::string* output = nullptr);

/// The error `job` throws; fails the test when it throws none.
Error error_of(const std::function<void()>& job);

/// Fraction of the pixels in a rectangle that are not white.
double painted(const Image& image, int x, int y, int width, int height);
double painted(const Image& image);

}  // namespace sinew
