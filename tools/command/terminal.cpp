// SPDX-License-Identifier: GPL-3.0-or-later
#include "command/terminal.h"

#include <unistd.h>
#include <cstdlib>
#include <cstring>

namespace sinew {
namespace {

constexpr auto between_lines = std::chrono::milliseconds(100);  // often enough for a terminal

bool has_colors(std::FILE* out) {
  const char* refused = std::getenv("NO_COLOR");
  const char* terminal = std::getenv("TERM");
  return isatty(fileno(out)) != 0 && !(refused && *refused) && terminal && *terminal &&
         std::strcmp(terminal, "dumb") != 0;
}

const char* code_of(TextColor color) {
  switch (color) {
    case TextColor::red:
      return "1;31";
    case TextColor::yellow:
      return "33";
    case TextColor::bold:
      break;
  }
  return "1";
}

}  // namespace

std::string in_color(TextColor color, const std::string& text, std::FILE* out) {
  if (!has_colors(out)) return text;
  return std::string("\033[") + code_of(color) + 'm' + text + "\033[0m";
}

ProgressStyle progress_style(bool quiet) {
  if (quiet) return ProgressStyle::none;
  return isatty(STDERR_FILENO) != 0 ? ProgressStyle::rewritten : ProgressStyle::lines;
}

ProgressLine::~ProgressLine() {
  if (width_ > 0) std::fputc('\n', out_);
}

void ProgressLine::rewrite(const std::string& line, bool last) {
  const auto now = Clock::now();
  if (!last && now - shown_ < between_lines) return;
  const std::size_t over = width_ > line.size() ? width_ - line.size() : 0;
  std::fprintf(out_, "\r%s%s", line.c_str(), std::string(over, ' ').c_str());
  std::fflush(out_);
  width_ = line.size();
  shown_ = now;
}

void ProgressLine::add(const std::string& line) {
  if (style_ != ProgressStyle::none) std::fprintf(out_, "%s\n", line.c_str());
}

}  // namespace sinew
