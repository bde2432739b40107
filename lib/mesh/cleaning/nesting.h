// SPDX-License-Identifier: GPL-3.0-or-later
// Which shells lie within which.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "mesh/winding.h"

namespace sinew {

/// A body's or cavity's boundary, outward.
struct Shell {
  std::vector<Corners> faces;
  std::vector<Corners> caps;  ///< close it
};

/// For each box of a shell the next shell outwards, -1 where there is none: the smallest around it
/// whose box holds its box and which holds the middles of its faces (up to 256, spread evenly), not
/// counting those on it. Shells are asked for only where boxes lie in each other.
std::vector<int> next_outer(std::span<const Box> boxes, const std::function<Shell(int)>& shell_of);

}  // namespace sinew
