// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/system.h>

#include <malloc.h>
#include <sys/auxv.h>
#include <sys/resource.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <ctime>
#include <fstream>
#include <limits>
#include <string>

namespace sinew {

std::string version() { return SINEW_VERSION; }

std::filesystem::path this_program() {
  namespace fs = std::filesystem;
  std::error_code failed;
  fs::path found = fs::read_symlink("/proc/self/exe", failed);
  if (!failed) return found;
  // NOLINTNEXTLINE(performance-no-int-to-ptr): the kernel gives it as a number
  const auto* started = reinterpret_cast<const char*>(::getauxval(AT_EXECFN));
  fs::path program = fs::absolute(started == nullptr ? "sinew" : started, failed);
  fs::path followed = fs::canonical(program, failed);
  return failed ? program : followed;
}

std::string time_text(const char* format, Zone zone) {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  zone == Zone::utc ? ::gmtime_r(&now, &parts) : ::localtime_r(&now, &parts);
  std::array<char, 64> text{};
  std::strftime(text.data(), text.size(), format, &parts);
  return text.data();
}

namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// The number after a word of a file of the kernel, or the first one of all for ""; else `other`.
double number_after(const std::string& file, const std::string& word, double other) {
  std::ifstream text(file);
  std::string key;
  double number = 0;
  if (word.empty()) return text >> number ? number : other;
  while (text >> key >> number) {
    if (key == word) return number;
    std::getline(text, key);
  }
  return other;
}

double free_of_machine() {
  const double kibibytes = number_after("/proc/meminfo", "MemAvailable:", -1);
  if (kibibytes >= 0) return kibibytes * 1024;
  return static_cast<double>(sysconf(_SC_AVPHYS_PAGES)) *
         static_cast<double>(sysconf(_SC_PAGESIZE));
}

/// Left of the address space, where ulimit -v bounds it.
double free_of_process() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return unlimited;
  const double pages = number_after("/proc/self/statm", "", 0);
  const double used = pages * static_cast<double>(sysconf(_SC_PAGESIZE));
  return std::max(0.0, static_cast<double>(limit.rlim_cur) - used);
}

/// Left of a control group's memory, as of a container; what it keeps of files does not count.
double free_of_group(const std::string& folder, const char* limit, const char* usage,
                     const char* files) {
  const double most = number_after(folder + limit, "", unlimited);
  if (most == unlimited) return unlimited;
  const double used = number_after(folder + usage, "", 0),
               of_files = number_after(folder + "/memory.stat", files, 0);
  return std::max(0.0, most - std::max(0.0, used - of_files));
}

/// Finds the least left in groups above this process, of either version. A container sees its own
/// as the top.
double free_of_groups() {
  std::ifstream groups("/proc/self/cgroup");
  double least = unlimited;
  for (std::string line; std::getline(groups, line);) {
    const auto path = line.rfind(':') + 1;
    const bool first = line.find(":memory:") != std::string::npos, second = line.starts_with("0::");
    if (!first && !second) continue;
    const std::string top = first ? "/sys/fs/cgroup/memory" : "/sys/fs/cgroup";
    for (std::string below = line.substr(path);; below.erase(below.rfind('/'))) {
      const std::string folder = top + (below == "/" ? "" : below);
      least = std::min(
          least, first ? free_of_group(folder, "/memory.limit_in_bytes", "/memory.usage_in_bytes",
                                       "total_inactive_file")
                       : free_of_group(folder, "/memory.max", "/memory.current", "inactive_file"));
      if (below.find('/') == std::string::npos) break;
    }
  }
  return least;
}

}  // namespace

double available_memory() {
  return std::min({free_of_machine(), free_of_process(), free_of_groups()});
}

void keep_freed_memory() {
  mallopt(M_MMAP_THRESHOLD, 32 << 20);  // the most that it takes; 3 bytes for 8 million pixels
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
}

void give_back_freed_memory() { malloc_trim(0); }

}  // namespace sinew
