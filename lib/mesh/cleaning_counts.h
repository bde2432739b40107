// SPDX-License-Identifier: GPL-3.0-or-later
// What cleaning and repairing a mesh came to, and what each count is called wherever it is told.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace sinew {

struct CleaningCounts {
  std::size_t points_read = 0;
  std::size_t polygons_read = 0;
  std::size_t polygons_cut = 0;     ///< polygons of four or more corners, cut into triangles
  std::size_t points_merged = 0;    ///< points equal to, or within the weld distance of, another
  std::size_t points_unused = 0;    ///< points of no face, left out
  std::size_t faces_collapsed = 0;  ///< faces left out because two of their corners are one point
  std::size_t faces_doubled = 0;    ///< faces left out because an earlier one has the same corners
  std::size_t faces_flat = 0;       ///< faces without area, kept: they may close the surface
  std::size_t faces_turned = 0;     ///< faces whose direction was reversed
  std::size_t holes_closed = 0;     ///< by faces_added new faces, where that was asked for
  std::size_t faces_added = 0;
  std::size_t faces_wrapped = 0;  ///< of the skin that replaced the mesh, where asked for
  std::size_t edges_twisted = 0;  ///< edges whose two faces cannot agree (as on a Moebius strip)
};

/// A count as reports name it.
struct NamedCount {
  enum class Of { file, cleaning, repair };  ///< repairs are done only when asked for

  std::string_view name;
  std::size_t CleaningCounts::*count;
  Of of;
};

/// All counts, in the order in which they are told.
std::span<const NamedCount> cleaning_counts();

}  // namespace sinew
