// SPDX-License-Identifier: GPL-3.0-or-later
// From what a file holds to a surface that can be filled.
#pragma once

#include <sinew/core/options.h>
#include <sinew/core/triangles.h>
#include <sinew/mesh/surface.h>

namespace sinew {

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
