// SPDX-License-Identifier: GPL-3.0-or-later
// VTK's test of points against a closed surface, to compare with.
#pragma once

#include <cstddef>

#include <sinew/core/triangles.h>

namespace sinew {

/// How many of the points vtkSelectEnclosedPoints puts inside.
std::size_t inside_by_vtk(const Triangles& surface, const Points& points);

}  // namespace sinew
