// SPDX-License-Identifier: GPL-3.0-or-later
// These tests draw, so the program sees to a display as the tools do.
#include <gtest/gtest.h>

#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <iostream>
#include <string_view>

#include <sinew/core/error.h>
#include <sinew/display/display.h>

int main(int argc, char** argv) {
  const std::string_view mode = argc > 1 ? argv[1] : "";
  const bool listing = mode == "--gtest_list_tests";
  try {
    if (!listing) sinew::ensure_display();
  } catch (const sinew::Error& error) {
    std::cerr << error.what() << '\n';
    return static_cast<int>(error.exit());
  }
  if (mode == "--tell-display-and-die") {
    std::cout << std::getenv("DISPLAY") << std::endl;
    std::raise(SIGKILL);
  }
  if (mode == "--become" && argc > 2) return execvp(argv[2], argv + 2);
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
