// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/fill/detail/exact.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/MP_Float.h>

namespace sinew::exact {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Kernel::Point_3 point(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

}  // namespace

int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return CGAL::orientation(point(a), point(b), point(c), point(d));
}

bool on_triangle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
  const Kernel::Triangle_3 triangle(point(a), point(b), point(c));
  return !triangle.is_degenerate() && triangle.has_on(point(p));
}

int compare_differences(double a, double b, double c, double d) {
  using Exact = CGAL::MP_Float;
  return CGAL::sign((Exact(b) - Exact(a)) - (Exact(d) - Exact(c)));
}

}  // namespace sinew::exact
