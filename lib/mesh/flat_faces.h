// SPDX-License-Identifier: GPL-3.0-or-later
// Faces without area, told exactly by CGAL's predicates.
#pragma once

#include <vector>

#include "core/triangles.h"

namespace sinew {

/// Per face, whether its corners lie on one line.
std::vector<bool> flat_faces(const Triangles& surface);

}  // namespace sinew
