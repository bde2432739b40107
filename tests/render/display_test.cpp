// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/display.h"

#include <algorithm>

#include "helpers.h"

namespace sinew {
namespace {

/// Runs this program's test of an empty shot in another environment.
int draw_with(const std::string& environment, std::string* output) {
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  return run("env -u SINEW_UNDER_XVFB " + environment + " " + self +
                 " --gtest_filter=Picture.an_empty_shot_is_white 2>&1",
             output);
}

TEST(Display, none_is_replaced_by_xvfb) {
  std::string output;
  EXPECT_EQ(draw_with("-u DISPLAY", &output), 0) << output;
  EXPECT_NE(output.find("1 test"), std::string::npos);
}

TEST(Display, one_that_does_not_answer_is_replaced_by_xvfb) {
  std::string output;
  EXPECT_EQ(draw_with("DISPLAY=:54321", &output), 0) << output;
}

TEST(Display, without_xvfb_one_line_says_what_to_install) {
  std::string output;
  EXPECT_EQ(draw_with("-u DISPLAY PATH=/nonexistent", &output), 4);
  EXPECT_NE(output.find("apt-get install xvfb xauth"), std::string::npos) << output;
  EXPECT_EQ(std::count(output.begin(), output.end(), '\n'), 1) << output;
}

}  // namespace
}  // namespace sinew
