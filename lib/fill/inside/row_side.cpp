// SPDX-License-Identifier: GPL-3.0-or-later
#include "fill/inside/row_side.h"

#include <algorithm>

#include "fill/inside/exact.h"

namespace sinew {
namespace {

int sign(double x) { return (x > 0) - (x < 0); }

}  // namespace

RowSide::RowSide(const Lattice& lattice, double largest)
    : lattice_(lattice), frame_(lattice), extent_(2 * largest) {}

int RowSide::exact(const Vec3& a, const Vec3& b, const LatticeRow& row) const {
  return frame_.handedness() *
         exact::orientation(a, b, lattice_.site(row, 0), lattice_.site(row, 1));
}

int RowSide::shifted(const Vec3& a, const Vec3& b) const {
  if (a.z() != b.z()) return sign(a.z() - b.z());
  if (!frame_.diagonal()) return sign(b.y() - a.y());
  const double run = (b.x() - a.x()) - (b.y() - a.y());
  return std::abs(run) > 8 * rounding * extent_
             ? sign(run)
             : exact::compare_differences(a.x(), b.x(), a.y(), b.y());
}

double largest_coordinate(const Lattice& lattice, const Points& points) {
  double largest = lattice.origin.cwiseAbs().maxCoeff();
  for (const Vec3& p : points) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  return largest;
}

}  // namespace sinew
