// SPDX-License-Identifier: GPL-3.0-or-later
// Progress of a run on standard error.
//
//     Progress progress(frames, progress_style(quiet));
//     progress.frame(1, time, steps);
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <cstdio>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "command/terminal.h"

namespace sinew {

/// "1:02:03", "0:52".
std::string duration_text(double seconds);

/// "frame 30/90  time 1 s  1234 steps/s  0:52 left  31 % spent waiting for frames to be written";
/// unknown parts (0, negative) and waits below a twentieth are left out.
std::string progress_text(int frame, int frames, double time, double steps_per_second,
                          double seconds_left, double fraction_waited = 0);

/// "frame 1/2  time 0.5 s  3000 iterations, residual 0.0012"
std::string iterations_text(int frame, int frames, double time, std::int64_t iterations,
                            double residual);

/// Progress of drawing or measuring: "measuring 45 %  0:05 left". On a terminal it appears after a
/// second; otherwise there is a line every ten seconds.
class StageProgress {
 public:
  /// `out` is for tests.
  StageProgress(std::string stage, ProgressStyle style, std::FILE* out = stderr)
      : stage_(std::move(stage)), line_(style, out) {}

  void at(std::size_t done, std::size_t of);

 private:
  using Clock = std::chrono::steady_clock;

  std::string stage_;
  ProgressLine line_;
  Clock::time_point start_ = Clock::now(), reported_ = start_;
  // What was done before the first call, or told at once with it, says nothing of the speed.
  std::optional<Clock::time_point> first_;
  Clock::time_point counted_from_ = start_;
  std::size_t done_before_ = 0;
};

/// A stage whose end cannot be foretold, while this lives: "looking at the mesh  3 s". Appears as
/// the progress of other stages does.
class Waiting {
 public:
  /// `out` is for tests.
  Waiting(std::string stage, ProgressStyle style, std::FILE* out = stderr);
  ~Waiting();
  Waiting(const Waiting&) = delete;
  Waiting& operator=(const Waiting&) = delete;

 private:
  void tell(std::unique_lock<std::mutex> lock);

  std::string stage_;
  ProgressLine line_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool over_ = false;
  std::thread teller_;
};

class Progress {
 public:
  /// `frames`: how many there will be after the first. `out` is for tests.
  Progress(int frames, ProgressStyle style, std::FILE* out = stderr);
  /// Reports frame `frame` at `time` (s of the scene) after `steps` steps of this run, which has
  /// `waited` (s) for frames to be written. The first call starts the clock.
  void frame(int frame, double time, std::int64_t steps, double waited = 0);
  /// Reports how near an equilibrium, that of frame `frame`, is after so many iterations.
  void iterations(int frame, double time, std::int64_t iterations, double residual);

 private:
  using Clock = std::chrono::steady_clock;

  int frames_;
  ProgressLine line_;
  bool begun_ = false;
  Clock::time_point start_;
  int first_frame_ = 0;
  std::int64_t first_steps_ = 0;
  double first_waited_ = 0;
  int tenths_ = 0;
  Clock::time_point reported_ = Clock::now();
};

}  // namespace sinew
