// SPDX-License-Identifier: GPL-3.0-or-later
// From a mesh file, or from polygons of any other source, to a surface. Files: OBJ, OFF (text), STL
// (text and binary) and PLY (text and binary), told by the extension.
#pragma once

#include <string>

#include "core/polygon_soup.h"
#include "core/settings.h"
#include "mesh/surface.h"

namespace sinew {

struct ReadOptions {
  double scale = 1;  ///< metres per unit of the coordinates; > 0
  double weld = 0;   ///< points closer than this become one, m (after scaling)
  FillRule rule = FillRule::unite;
};

/// What the file holds, unchanged: at least one face, corners that exist, finite coordinates.
/// Throws Error (bad input) naming file, line where there is one, fault and cure.
PolygonSoup read_polygons(const std::string& path);

/// Throws Error (bad input) unless the soup is as read_polygons() gives it.
void check_soup(const PolygonSoup& soup);

/// Checked, scaled, and cleaned as mesh/clean.h says. Throws Error (bad input).
Surface surface_from(PolygonSoup soup, const ReadOptions& options = {});

/// Both in one; errors name the file.
Surface read_surface(const std::string& path, const ReadOptions& options = {});

}  // namespace sinew
