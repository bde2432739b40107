// SPDX-License-Identifier: GPL-3.0-or-later
// The sites of closest packings (FCC, HCP) in a box, as rows along a close-packed direction, in
// which sites follow each other at 2r. A site lies at the box's centre, so that a symmetric body is
// filled symmetrically and no layer lies on the faces of a box.
#pragma once

#include <array>
#include <vector>

#include "core/settings.h"
#include "core/vector.h"

namespace sinew {

using LatticePlace = std::array<int, 3>;  ///< a site in steps of Lattice::unit from the centre

struct LatticeRow {
  LatticePlace first;
  int sites;
};

struct Lattice {
  Vec3 centre;                   ///< of the box, m; a site
  Vec3 unit;                     ///< m; FCC: sites are where i + j + k is even, of step sqrt(2) r
  LatticePlace along;            ///< from a site to the next of its row
  std::vector<LatticeRow> rows;  ///< by z, then across the row: a fixed order

  /// Site n of a row, m. Sites of one layer have bit-identical coordinates.
  Vec3 site(const LatticeRow& row, int n) const;
};

/// All sites within the box (not empty; a size below 1e9 r) and on its surface, for radius r > 0
/// (m).
Lattice lattice_in(const Box& box, Packing packing, double radius);

/// About how many sites and rows that will be.
struct LatticeSize {
  double sites, rows;
};
LatticeSize lattice_size(const Box& box, double radius);

}  // namespace sinew
