// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets.h"

namespace sinew::fuzz {

std::vector<Target> tried_targets() {
  return {{"obj", obj}, {"off", off}, {"ply", ply}, {"stl", stl}};
}

}  // namespace sinew::fuzz
