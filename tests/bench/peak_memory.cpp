// SPDX-License-Identifier: GPL-3.0-or-later
#include <malloc.h>
#include <fstream>
#include <string>

#include <sinew/core/error.h>

#include "bench/peak_memory.h"

namespace sinew::bench {
namespace {

/// A line of /proc/self/status, in bytes.
double status(const std::string& wanted) {
  std::ifstream file("/proc/self/status");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with(wanted)) return 1024 * std::stod(line.substr(wanted.size()));
  throw bad_input("/proc/self/status has no line " + wanted, "measure memory on Linux");
}

/// Resets the peak to the present size.
void forget_peak() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";
}

}  // namespace

double peak_memory_of(const std::function<void()>& job) {
  forget_peak();
  const double before = status("VmRSS:");
  job();
  return status("VmHWM:") - before;
}

}  // namespace sinew::bench
