// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/display.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>

#include "helpers.h"

namespace sinew {
namespace {

/// Runs this program's test of an empty shot in another environment.
int draw_with(const std::string& environment, std::string* output) {
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  return run(
      "env " + environment + " " + self + " --gtest_filter=Picture.an_empty_shot_is_white 2>&1",
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
  EXPECT_NE(output.find("apt-get install xvfb"), std::string::npos) << output;
  EXPECT_EQ(std::count(output.begin(), output.end(), '\n'), 1) << output;
}

TEST(Display, ends_with_the_program_even_when_that_is_killed) {
  int pipe_ends[2];
  ASSERT_EQ(pipe(pipe_ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    unsetenv("DISPLAY");
    ensure_display();
    const std::string name = std::getenv("DISPLAY");
    (void)!write(pipe_ends[1], name.c_str(), name.size());
    raise(SIGKILL);
  }
  char name[32] = "";
  ASSERT_GT(read(pipe_ends[0], name, sizeof name - 1), 1);
  waitpid(child, nullptr, 0);
  const std::string socket = std::string("/tmp/.X11-unix/X") + (name + 1);
  for (int i = 0; i < 500 && std::filesystem::exists(socket); ++i) usleep(10000);
  EXPECT_FALSE(std::filesystem::exists(socket));
}

}  // namespace
}  // namespace sinew
