// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/settings/settings.h>

#include <algorithm>

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

bool Settings::moves_initially() const {
  return body.moves() || std::any_of(bodies.begin(), bodies.end(),
                                     [](const PartOptions& part) { return part.body.moves(); });
}

}  // namespace sinew
