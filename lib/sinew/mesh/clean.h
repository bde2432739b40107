// SPDX-License-Identifier: GPL-3.0-or-later
// From what a file holds to a surface that can be filled.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include <sinew/core/triangles.h>
#include <sinew/mesh/surface.h>
#include <sinew/settings/settings.h>

namespace sinew {

// What cleaning and repairing a mesh came to, and what each count is called wherever it is told.

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

// What must hold of a soup before anything is done with it.

/// Throws Error (bad input) unless it has faces, each of three corners or more that are points of
/// it, and coordinates that are finite.
void check_soup(const PolygonSoup& soup);

struct CleaningOptions {
  double weld = 0;  ///< points closer than this become one, m; 0: only equal ones
  FillRule rule = FillRule::unite;
};

/// In this order: cuts polygons into triangles, merges points (the first of them keeps its place,
/// so a mesh without defects keeps its points in file order), drops collapsed faces, merges doubled
/// ones whatever their direction, makes directions agree across edges of two faces, as most of the
/// area has them, and turns bodies outward by the sign of the volume they enclose once their holes
/// are capped. Pieces too flat to tell follow the others. A shell within another one is a cavity
/// where it turns against that one in the file; with the rule `hollow` every second shell is one.
/// Shells that cut each other are bodies each. Never refuses a surface for holes, crowded edges or
/// cuts: it counts them. Throws Error (bad input), naming the number that decided and a cure, when
/// no face is left or coordinates are too large for numbers to hold volumes.
Surface clean(const PolygonSoup& soup, const CleaningOptions& options = {});

}  // namespace sinew
