// SPDX-License-Identifier: GPL-3.0-or-later
// From what a file holds to the surface that a body's settings ask for.
#pragma once

#include "core/polygon_soup.h"
#include "core/settings.h"
#include "mesh/surface.h"

namespace sinew {

/// In metres, by unit and scale, and in the scene's directions, by up and forward; welded and cleaned; its holes closed, and replaced by a skin
/// around it, where the settings ask for that. Throws Error (bad input) where the soup has no
/// faces, faces of fewer than 3 corners, corners that are no points or coordinates that are not
/// finite, where the scale is not above 0, where closing holes leaves no face, and as clean() and
/// repair.h do.
Surface prepare(PolygonSoup soup, const BodySettings& body);

}  // namespace sinew
