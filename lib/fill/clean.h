// SPDX-License-Identifier: GPL-3.0-or-later
// From what a file holds to a closed surface that points outward, or a clear refusal.
#pragma once

#include "fill/closed_surface.h"
#include "fill/polygon_soup.h"

namespace sinew {

/// In this order: cuts polygons into triangles, merges equal points (the first of them keeps its
/// place, so a mesh without defects keeps its points in file order), drops collapsed faces, merges
/// doubled ones whatever their direction, makes directions agree, turns bodies outward by the sign
/// of their volume and cavities inward. Throws Error (bad input), naming the number that decided
/// and a cure, for surfaces that are open, have edges of three or more faces, cannot be oriented,
/// cut themselves or enclose no volume.
ClosedSurface clean(PolygonSoup soup);

}  // namespace sinew
