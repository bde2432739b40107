// SPDX-License-Identifier: GPL-3.0-or-later
// On which side of a row an edge passes it, seen along the row: exactly, and without ties.
#pragma once

#include "fill/inside/row_frame.h"

namespace sinew {

class RowSide {
 public:
  /// No coordinate of an edge may exceed `largest`, m.
  RowSide(const Lattice& lattice, double largest);

  /// The sign of (a - q) x (b - q) in the plane (across, up), q being the row; 0: the row meets the
  /// edge's line.
  int exact(const Vec3& a, const Vec3& b, const LatticeRow& row) const;

  /// What an exact sign of 0 becomes when the row is shifted a little across, and by much less up;
  /// 0 only for edges along the row.
  int shifted(const Vec3& a, const Vec3& b) const;

  /// A bound on all coordinates, and on `across`, m.
  double extent() const { return extent_; }

 private:
  const Lattice& lattice_;
  RowFrame frame_;
  double extent_;
};

/// The largest coordinate of a lattice's box and of points, in absolute value, m.
double largest_coordinate(const Lattice& lattice, const Points& points);

}  // namespace sinew
