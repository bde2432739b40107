// SPDX-License-Identifier: GPL-3.0-or-later
// A coarser skin out of some of a surface's own points, for pictures (Rossignac and Borrel's vertex
// clustering): one point stays of each cell of a grid.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <sinew/core/triangles.h>

namespace sinew {

struct ThinSurface {
  std::vector<std::uint32_t> points;      ///< of the surface, ascending
  std::vector<std::array<int, 3>> faces;  ///< indices into points
};

/// At most `most` points, all of a surface that has no more; faces that collapse go.
ThinSurface thin_surface(const Triangles& surface, std::size_t most);

}  // namespace sinew
