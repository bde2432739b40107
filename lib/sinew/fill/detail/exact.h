// SPDX-License-Identifier: GPL-3.0-or-later
// Exact signs for any doubles, by CGAL's predicates.
#pragma once

#include <sinew/core/vector.h>

namespace sinew::exact {

/// The sign of (b - a) x (c - a) . (d - a): on which side of the plane abc the point d lies.
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Whether p lies on the closed triangle abc. False for triangles without area.
bool on_triangle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p);

/// The sign of (b - a) - (d - c).
int compare_differences(double a, double b, double c, double d);

}  // namespace sinew::exact
