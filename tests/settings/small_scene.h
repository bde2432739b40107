// SPDX-License-Identifier: GPL-3.0-or-later
// A minimal scene to which tests add lines; it has 8.
#pragma once

#include <string>

namespace sinew {

inline const std::string small_scene =
    "body:\n"
    "  mesh: box.obj\n"
    "  radius: 0.01\n"
    "skeleton:\n"
    "  bones:\n"
    "    - name: lower\n"
    "      head: [0, 0, 0]\n"
    "      tail: [0, 0, 1]\n";

}  // namespace sinew
