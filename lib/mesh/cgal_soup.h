// SPDX-License-Identifier: GPL-3.0-or-later
// The one door to CGAL's mesh readers.
#pragma once

#include <optional>
#include <string>

#include "mesh/mesh_file.h"
#include "core/polygon_soup.h"

namespace sinew {

/// What CGAL reads from the text of a file that plain_mesh has made plain; nothing where it fails.
std::optional<PolygonSoup> soup_by_cgal(MeshFormat format, std::string plain);

}  // namespace sinew
