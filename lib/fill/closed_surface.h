// SPDX-License-Identifier: GPL-3.0-or-later
// A surface that encloses a volume: what the fill asks for and cleaning makes.
#pragma once

#include <cstddef>
#include <vector>

#include "core/triangles.h"

namespace sinew {

/// What cleaning found and did.
struct CleaningCounts {
  std::size_t points_read = 0;
  std::size_t polygons_read = 0;
  std::size_t polygons_cut = 0;     ///< polygons of four or more corners, cut into triangles
  std::size_t points_merged = 0;    ///< points equal to an earlier one
  std::size_t points_unused = 0;    ///< points of no face, left out
  std::size_t faces_collapsed = 0;  ///< faces left out because two of their corners are one point
  std::size_t faces_doubled = 0;    ///< faces left out because an earlier one has the same corners
  std::size_t faces_flat = 0;       ///< faces without area, kept: they close the surface
  std::size_t faces_turned = 0;     ///< faces whose direction was reversed
};

/// Triangles that use every edge once in each direction, cut neither each other nor themselves, and
/// turn counter-clockwise seen from outside the body; a cavity's seen from within the cavity.
struct ClosedSurface {
  Triangles triangles;
  std::vector<int> body;  ///< per face: the body it bounds, 0 .. bodies - 1
  int bodies = 0;         ///< separate bodies; a cavity belongs to the body around it
  int cavities = 0;       ///< hollows within bodies
  CleaningCounts cleaning;
  double seconds_reading = 0, seconds_cleaning = 0;
};

}  // namespace sinew
