// SPDX-License-Identifier: GPL-3.0-or-later
// Which shells lie within which: every second one within another bounds a cavity.
#pragma once

#include <vector>

#include "mesh/edges.h"

namespace sinew {

struct Nesting {
  std::vector<int> body;     ///< per shell: the body it bounds
  std::vector<bool> cavity;  ///< per shell: whether it bounds a cavity of that body
  int bodies = 0;
};

/// For closed shells that do not cut each other, each turning one way throughout. By the sum of the
/// solid angles (van Oosterom and Strackee 1983) under which a shell is seen from another one's
/// face.
Nesting nesting_of(const Triangles& surface, const Shells& shells);

}  // namespace sinew
