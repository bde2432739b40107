// SPDX-License-Identifier: GPL-3.0-or-later
// From what a file holds to the surface that a body's settings ask for.
#pragma once

#include "core/polygon_soup.h"
#include "core/settings.h"
#include "mesh/surface.h"

namespace sinew {

/// In metres, by unit and scale; welded and cleaned; its holes closed, and replaced by a skin around
/// it, where the settings ask for that. Throws Error (bad input) as clean() and repair.h do.
Surface prepare(PolygonSoup soup, const BodySettings& body);

/// One of a mesh's units, m.
double metres(LengthUnit unit);

}  // namespace sinew
