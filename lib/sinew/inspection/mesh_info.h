// SPDX-License-Identifier: GPL-3.0-or-later
// What is in a mesh, and what is wrong with it: counts, sizes, radii that suit it, and the defects
// as geometry.
//
//     const MeshInfo info = inspect_mesh(surface);
//     write_defects("defects.vtu", drawing_of(surface, info.defects));
#pragma once

#include <string>
#include <vector>

#include <sinew/inspection/findings.h>
#include <sinew/io/single_files.h>
#include <sinew/mesh/surface.h>
#include <sinew/repair/diagnosis.h>

namespace sinew {

struct MeshInfo {
  Findings findings;
  Defects defects;
  std::vector<std::string> warnings;  ///< each with its cure
};

/// Takes seconds for a million faces.
MeshInfo inspect_mesh(const Surface& surface);

/// The worst defect of each face and edge, by the numbers of the array `defect`.
DefectsFile drawing_of(const Surface& surface, const Defects& defects);

}  // namespace sinew
