// SPDX-License-Identifier: GPL-3.0-or-later
// What people see on a terminal: colors, and lines of progress that are rewritten.
//
//     std::fputs(in_color(TextColor::red, "sinew:", stderr).c_str(), stderr);
#pragma once

#include <chrono>
#include <cstdio>
#include <string>

namespace sinew {

enum class TextColor { bold, red, yellow };

/// The text in that color where `out` is a terminal with colors and the environment has no NO_COLOR
/// (no-color.org), else as it is.
std::string in_color(TextColor color, const std::string& text, std::FILE* out);

enum class ProgressStyle { none, lines, rewritten };

/// One line rewritten on a terminal, otherwise one line per tenth of the run; nothing when quiet.
ProgressStyle progress_style(bool quiet);

/// A line of progress, which a terminal rewrites.
class ProgressLine {
 public:
  ProgressLine(ProgressStyle style, std::FILE* out) : style_(style), out_(out) {}
  ~ProgressLine();  ///< ends a rewritten line, so that later output begins on a line of its own
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  ProgressStyle style() const { return style_; }
  /// On a terminal; not if that was done a moment ago, unless it is the last time.
  void rewrite(const std::string& line, bool last);
  void add(const std::string& line);  ///< below the others

 private:
  using Clock = std::chrono::steady_clock;

  ProgressStyle style_;
  std::FILE* out_;
  Clock::time_point shown_;
  std::size_t width_ = 0;
};

}  // namespace sinew
