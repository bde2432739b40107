// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/system.h>

#include <unistd.h>
#include <fstream>
#include <string>

namespace sinew {

std::string version() { return SINEW_VERSION; }

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

}  // namespace sinew
