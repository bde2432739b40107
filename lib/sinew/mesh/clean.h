// SPDX-License-Identifier: GPL-3.0-or-later
// Cleans the polygons of a mesh file into a surface that can be filled.
//
//     const Surface surface = clean(read_polygons("part.stl"), {.weld = 1e-6});
#pragma once

#include <sinew/core/options.h>
#include <sinew/core/triangles.h>
#include <sinew/mesh/surface.h>

namespace sinew {

/// Throws Error (bad input) unless the soup has faces, each of three corners or more that are
/// points of it, and finite coordinates.
void check_soup(const PolygonSoup& soup);

/// The faces as polygons.
PolygonSoup soup_of(const Triangles& triangles);

struct CleaningOptions {
  double weld = 0;  ///< points closer than this are merged, m; 0: only equal ones
  FillRule rule = FillRule::unite;
};

/// In this order: cuts polygons into triangles, merges points (the first of them is kept, so a mesh
/// without defects keeps its points in file order), drops collapsed faces, merges doubled ones in
/// either orientation, leaves out both of two opposite ones where solids touch, makes orientations
/// agree across edges of two faces, following most of the area, and turns bodies outward by the
/// sign of the volume they enclose once their holes are capped. Pieces too flat to decide follow
/// the others. A shell inside another one is a cavity where its orientation in the file is
/// opposite; with the rule `hollow` every second shell is one. Shells that cut each other are
/// separate bodies. Holes, crowded edges and self-intersections are counted, never refused. Throws
/// Error (bad input), naming the decisive number and a cure, where no face is left or coordinates
/// are too large for volumes to be computed.
Surface clean(const PolygonSoup& soup, const CleaningOptions& options = {});

}  // namespace sinew
