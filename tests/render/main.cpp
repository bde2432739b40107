// SPDX-License-Identifier: GPL-3.0-or-later
// These tests draw, so the program sees to a display as the tools do.
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <iostream>
#include <string_view>

#include <sinew/core/error.h>
#include <sinew/render/display.h>

int main(int argc, char** argv) {
  const bool dying = argc > 1 && std::string_view(argv[1]) == "--tell-display-and-die";
  const bool listing = argc > 1 && std::string_view(argv[1]) == "--gtest_list_tests";
  try {
    if (!listing) sinew::ensure_display();
  } catch (const sinew::Error& error) {
    std::cerr << error.what() << '\n';
    return static_cast<int>(error.exit());
  }
  if (dying) {
    std::cout << std::getenv("DISPLAY") << std::endl;
    std::raise(SIGKILL);
  }
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
