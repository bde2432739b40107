// SPDX-License-Identifier: GPL-3.0-or-later
#include "command/progress.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <utility>

namespace sinew {
namespace {

constexpr double worth_telling =
    0.05;  // fraction of the time that the simulation waits for writing
constexpr auto between = std::chrono::seconds(10);  // time between lines that are not rewritten

}  // namespace

std::string duration_text(double seconds) {
  const auto whole = static_cast<std::int64_t>(std::min(std::ceil(seconds), 1e9));
  const auto hours = whole / 3600, minutes = whole / 60 % 60, rest = whole % 60;
  if (hours > 0) return fmt::format("{}:{:02}:{:02}", hours, minutes, rest);
  return fmt::format("{}:{:02}", minutes, rest);
}

std::string progress_text(int frame, int frames, double time, double steps_per_second,
                          double seconds_left, double fraction_waited) {
  std::string text = fmt::format("frame {}/{}  time {:.4g} s", frame, frames, time);
  if (steps_per_second > 0) text += fmt::format("  {:.0f} steps/s", steps_per_second);
  if (seconds_left > 0) text += fmt::format("  {} left", duration_text(seconds_left));
  if (fraction_waited > worth_telling)
    text += fmt::format("  {:.0f} % spent waiting for frames to be written", 100 * fraction_waited);
  return text;
}

std::string iterations_text(int frame, int frames, double time, std::int64_t iterations,
                            double residual) {
  return progress_text(frame, frames, time, 0, 0) +
         fmt::format("  {} iterations, residual {:.2g}", iterations, residual);
}

void StageProgress::at(std::size_t done, std::size_t of) {
  constexpr auto until_rewritten = std::chrono::seconds(1);
  constexpr auto at_once = std::chrono::milliseconds(100);
  const auto now = Clock::now();
  if (done == 0) return;
  if (!first_) first_ = now;
  if (now - *first_ < at_once) {
    counted_from_ = now, done_before_ = done;
    return;
  }
  if (now - start_ < until_rewritten) return;
  const double seconds = std::chrono::duration<double>(now - counted_from_).count();
  const double left = seconds * static_cast<double>(of - done) /
                      static_cast<double>(std::max<std::size_t>(1, done - done_before_));
  const std::string line =
      fmt::format("{} {} %{}", stage_, 100 * done / of,
                  done < of ? "  " + duration_text(left) + " left" : std::string());
  if (line_.style() == ProgressStyle::rewritten)
    line_.rewrite(line, done == of);
  else if (now - reported_ >= between)
    line_.add(line), reported_ = now;
}

Waiting::Waiting(std::string stage, ProgressStyle style, std::FILE* out)
    : stage_(std::move(stage)), line_(style, out) {
  if (style != ProgressStyle::none)
    teller_ = std::thread([this] { tell(std::unique_lock(mutex_)); });
}

Waiting::~Waiting() {
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  changed_.notify_one();
  if (teller_.joinable()) teller_.join();
}

void Waiting::tell(std::unique_lock<std::mutex> lock) {
  const bool rewrites = line_.style() == ProgressStyle::rewritten;
  const std::chrono::seconds pause = rewrites ? std::chrono::seconds(1) : between;
  for (auto waited = pause; !changed_.wait_for(lock, pause, [this] { return over_; });
       waited += pause) {
    const std::string line = fmt::format("{}  {} s", stage_, waited.count());
    rewrites ? line_.rewrite(line, false) : line_.add(line);
  }
}

Progress::Progress(int frames, ProgressStyle style, std::FILE* out)
    : frames_(frames), line_(style, out) {}

void Progress::frame(int frame, double time, std::int64_t steps, double waited) {
  if (line_.style() == ProgressStyle::none) return;
  const auto now = Clock::now();
  if (!std::exchange(begun_, true)) {
    start_ = now;
    first_frame_ = frame;
    first_steps_ = steps;
    first_waited_ = waited;
    tenths_ = frames_ > 0 ? frame * 10 / frames_ : 0;
    return;
  }
  const double seconds = std::chrono::duration<double>(now - start_).count();
  const double speed = seconds > 0 ? static_cast<double>(steps - first_steps_) / seconds : 0;
  const double left = seconds * (frames_ - frame) / std::max(1, frame - first_frame_);
  const double in_vain = std::min(1.0, (waited - first_waited_) / std::max(seconds, 1e-9));
  const std::string line = progress_text(frame, frames_, time, speed, left, in_vain);
  const int tenths = frames_ > 0 ? static_cast<int>(std::int64_t{frame} * 10 / frames_) : 0;
  if (line_.style() == ProgressStyle::rewritten)
    line_.rewrite(line, frame >= frames_);
  else if (tenths > tenths_)
    line_.add(line);
  tenths_ = std::max(tenths_, tenths);
}

void Progress::iterations(int frame, double time, std::int64_t iterations, double residual) {
  const std::string line = iterations_text(frame, frames_, time, iterations, residual);
  const auto now = Clock::now();
  if (line_.style() == ProgressStyle::rewritten)
    line_.rewrite(line, false);
  else if (line_.style() == ProgressStyle::lines && now - reported_ >= between)
    line_.add(line), reported_ = now;
}

}  // namespace sinew
