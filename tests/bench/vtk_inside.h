// SPDX-License-Identifier: GPL-3.0-or-later
// VTK's test of points in a closed surface, for comparison.
#pragma once

#include <cstddef>

#include <sinew/core/triangles.h>

namespace sinew {

/// How many of the points vtkSelectEnclosedPoints puts inside.
std::size_t inside_by_vtk(const Triangles& surface, const Points& points);

}  // namespace sinew
