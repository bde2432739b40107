// SPDX-License-Identifier: GPL-3.0-or-later
// Progress of a run on standard error.
//
//     Progress progress(frames, progress_style(quiet));
//     progress.frame(1, time, steps);
#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <string>

namespace sinew {

enum class ProgressStyle { none, lines, rewritten };

/// One line rewritten on a terminal, otherwise one line per tenth of the run; nothing when quiet.
/// No colors and no escape sequences, so NO_COLOR and plain terminals are respected.
ProgressStyle progress_style(bool quiet);

/// "frame 30/90  time 1 s  1234 steps/s  0:52 left  31 % spent waiting for the disk"; unknown parts
/// (0, negative) and waits below a twentieth are left out.
std::string progress_text(int frame, int frames, double time, double steps_per_second,
                          double seconds_left, double share_waited = 0);

class Progress {
 public:
  /// `frames`: how many there will be after the first. `out` is for tests.
  Progress(int frames, ProgressStyle style, std::FILE* out = stderr);
  ~Progress();  ///< ends a rewritten line, so that later output begins on a line of its own
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Reports frame `frame` at `time` (s of the scene) after `steps` steps of this run, which has
  /// `waited` (s) for frames to be written. The first call starts the clock.
  void frame(int frame, double time, std::int64_t steps, double waited = 0);

 private:
  using Clock = std::chrono::steady_clock;

  void rewrite(const std::string& line);

  int frames_;
  ProgressStyle style_;
  std::FILE* out_;
  bool begun_ = false;
  Clock::time_point start_, shown_;
  int first_frame_ = 0;
  std::int64_t first_steps_ = 0;
  int tenths_ = 0;
  std::size_t width_ = 0;
};

}  // namespace sinew
