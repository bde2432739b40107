// SPDX-License-Identifier: GPL-3.0-or-later
// The program and the machine it runs on: its version, the memory that is free, the time that
// passes.
#pragma once

#include <chrono>
#include <string>
#include <utility>

namespace sinew {

/// "0.2.0"
std::string version();

/// How much memory can be taken without swapping, bytes: the kernel's estimate (free pages and what
/// caches give back), else the free pages alone.
double available_memory();

/// Seconds per stage, for reports.
class Stopwatch {
 public:
  /// Seconds since the last lap, or the start, without a new lap.
  double seconds() const { return std::chrono::duration<double>(Clock::now() - last_).count(); }
  /// The same, and a lap begins.
  double lap() {
    const auto last = std::exchange(last_, Clock::now());
    return std::chrono::duration<double>(last_ - last).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
};

}  // namespace sinew
