// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/settings.h"

namespace sinew {

double metres(LengthUnit unit) {
  switch (unit) {
    case LengthUnit::m:
      return 1;
    case LengthUnit::dm:
      return 0.1;
    case LengthUnit::cm:
      return 0.01;
    case LengthUnit::mm:
      return 0.001;
    case LengthUnit::um:
      return 1e-6;
    case LengthUnit::inch:
      return 0.0254;
    case LengthUnit::foot:
      return 0.3048;
  }
  return 1;
}

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
