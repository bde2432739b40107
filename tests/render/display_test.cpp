// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/display/display.h>

#include <unistd.h>

#include <algorithm>

#include "helpers.h"

namespace sinew::display_test {

std::string self() { return std::filesystem::read_symlink("/proc/self/exe").string(); }

/// Runs this program's test of an empty snapshot in another environment.
int draw_with(const std::string& environment, std::string* output) {
  return run("env " + environment + " " + self() +
                 " --gtest_filter=Picture.an_empty_snapshot_is_white 2>&1",
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
  const Folder folder;
  std::string output;
  EXPECT_EQ(draw_with("-u DISPLAY PATH=" + folder.file("missing"), &output), 4);
  EXPECT_NE(output.find("apt-get install xvfb"), std::string::npos) << output;
  EXPECT_EQ(std::count(output.begin(), output.end(), '\n'), 1) << output;
}

TEST(Display, ends_with_the_program_even_when_that_is_killed) {
  std::string name;
  run("env -u DISPLAY " + self() + " --tell-display-and-die", &name);
  ASSERT_EQ(name.front(), ':');
  const std::string socket = "/tmp/.X11-unix/X" + name.substr(1, name.size() - 2);
  for (int i = 0; i < 500 && std::filesystem::exists(socket); ++i) usleep(10000);
  EXPECT_FALSE(std::filesystem::exists(socket));
}

TEST(Display, answers_a_program_that_connects_again_and_again) {
  // The greeting of a client without credentials, least significant byte first; 1 means welcome.
  const std::string connect =
      "python3 -c \"import os, socket, struct\n"
      "for _ in range(500):\n"
      " server = socket.socket(socket.AF_UNIX)\n"
      " server.connect('/tmp/.X11-unix/X' + os.environ['DISPLAY'][1:])\n"
      " server.send(struct.pack('<BxHHHH2x', 0x6c, 11, 0, 0, 0))\n"
      " assert server.recv(8)[:1] == bytes([1])\n"
      " server.close()\"";
  std::string output;
  EXPECT_EQ(run("env -u DISPLAY " + self() + " --become " + connect + " 2>&1", &output), 0)
      << output;
}

}  // namespace sinew::display_test
