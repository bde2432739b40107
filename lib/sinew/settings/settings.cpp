// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/settings/settings.h>

namespace sinew {

Place Settings::place(std::string path) const {
  while (true) {
    if (const auto found = places.find(path); found != places.end()) return found->second;
    const auto cut = path.find_last_of(".[");
    if (cut == std::string::npos) break;
    path.resize(cut);
  }
  const auto scene = places.find("");
  return scene == places.end() ? Place{} : scene->second;
}

}  // namespace sinew
