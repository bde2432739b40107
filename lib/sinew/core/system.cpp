// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/system.h>

#include <malloc.h>
#include <unistd.h>
#include <array>
#include <ctime>
#include <fstream>
#include <string>

namespace sinew {

std::string version() { return SINEW_VERSION; }

std::string time_text(const char* format, Zone zone) {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  zone == Zone::utc ? ::gmtime_r(&now, &parts) : ::localtime_r(&now, &parts);
  std::array<char, 64> text{};
  std::strftime(text.data(), text.size(), format, &parts);
  return text.data();
}

double available_memory() {
  std::ifstream info("/proc/meminfo");
  std::string key;
  double kibibytes = 0;
  while (info >> key >> kibibytes) {
    if (key == "MemAvailable:") return kibibytes * 1024;
    std::getline(info, key);
  }
  return static_cast<double>(sysconf(_SC_AVPHYS_PAGES)) *
         static_cast<double>(sysconf(_SC_PAGESIZE));
}

void keep_freed_memory() {
  mallopt(M_MMAP_THRESHOLD, 32 << 20);  // the most that it takes; 3 bytes for 8 million pixels
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
}

void give_back_freed_memory() { malloc_trim(0); }

}  // namespace sinew
