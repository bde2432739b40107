// SPDX-License-Identifier: GPL-3.0-or-later
#include "helpers.h"

#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>

namespace sinew {

int run(const std::string& command, std::string* output) {
  std::FILE* pipe = popen(command.c_str(), "r");
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe))
    if (output) *output += static_cast<char>(c);
  const int status = pclose(pipe);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

Error error_of(const std::function<void()>& job) {
  try {
    job();
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "no error was thrown";
  return Error(Exit::done, "");
}

double painted(const Image& image, int x, int y, int width, int height) {
  int count = 0;
  for (int row = y; row < y + height; ++row)
    for (int column = x; column < x + width; ++column) {
      const std::uint8_t* pixel = image.at(column, row);
      count += pixel[0] != 255 || pixel[1] != 255 || pixel[2] != 255;
    }
  return count / (static_cast<double>(width) * height);
}

double painted(const Image& image) { return painted(image, 0, 0, image.width, image.height); }

}  // namespace sinew
