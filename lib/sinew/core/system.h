// SPDX-License-Identifier: GPL-3.0-or-later
// The program and its machine: version, available memory, elapsed time.
//
//     Stopwatch watch;
//     seconds += watch.lap();
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <utility>

namespace sinew {

/// "0.2.0"
std::string version();

/// The file of this program, links followed. Without /proc, what it was started by.
std::filesystem::path this_program();

enum class Zone { utc, local };

/// The present time as strftime's `format` says.
std::string time_text(const char* format, Zone zone);

/// Memory that this process can allocate without swapping, bytes: the kernel's estimate (free pages
/// and reclaimable caches), less where a control group or the address space (ulimit -v) is limited.
double available_memory();

/// Memory that is freed stays with the program, for those that allocate megabytes again and again:
/// taking pages from the kernel each time costs a tenth of drawing.
void keep_freed_memory();

/// Memory that was freed, but lies between what is still in use, goes back to the system.
void give_back_freed_memory();

/// Seconds per stage, for reports.
class Stopwatch {
 public:
  /// Seconds since the last lap, or the start, without a new lap.
  double seconds() const { return std::chrono::duration<double>(Clock::now() - last_).count(); }
  /// The same, and starts a lap.
  double lap() {
    const auto last = std::exchange(last_, Clock::now());
    return std::chrono::duration<double>(last_ - last).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
};

}  // namespace sinew
