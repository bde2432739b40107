// SPDX-License-Identifier: GPL-3.0-or-later
// What is wrong with a mesh, to be seen in ParaView: its faces and its defective edges, marked.
#pragma once

#include <filesystem>
#include <vector>

#include "core/triangles.h"

namespace sinew {

/// One number per face, then one per edge, where not said otherwise.
struct DefectsFile {
  Triangles surface;
  std::vector<std::array<std::int32_t, 2>> edges;  ///< points of each defective edge
  std::vector<std::int32_t> defect;   ///< 0 none, 1 open, 2 crowded, 3 twisted edge; 4 turned,
                                      ///< 5 cutting, 6 flat face
  std::vector<std::int32_t> component;  ///< -1 for edges
  std::vector<std::int32_t> hole;       ///< -1 for faces and closed edges
};

/// A VTU of triangles followed by lines. Throws not written.
void write_defects(const std::filesystem::path& path, const DefectsFile& defects);

}  // namespace sinew
