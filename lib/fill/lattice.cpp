// SPDX-License-Identifier: GPL-3.0-or-later
#include "fill/lattice.h"

#include <algorithm>
#include <cmath>

#include "core/closest_packing.h"

namespace sinew {
namespace {

/// Steps from the centre to the box's side. Rounding must not lose a site on the surface.
LatticePlace reach(const Box& box, const Vec3& unit) {
  LatticePlace steps;
  for (int axis = 0; axis < 3; ++axis)
    steps[axis] = static_cast<int>(std::floor(box.sizes()[axis] / 2 / unit[axis] + 1e-9));
  return steps;
}

bool odd(int i) { return i % 2 != 0; }

/// Rows along (1, 1, 0) of the sites with i + j + k even: i - j stays the same in each.
void add_fcc_layer(Lattice& lattice, const LatticePlace& most, int k) {
  const int widest = most[0] + most[1];
  for (int across = -widest; across <= widest; ++across) {
    if (odd(across) != odd(k)) continue;
    const int from = std::max(-most[0], across - most[1]);
    const int to = std::min(most[0], across + most[1]);
    if (from <= to) lattice.rows.push_back({{from, from - across, k}, to - from + 1});
  }
}

/// Rows along x in steps of 2 r; layers alternate, every second one lies in the first one's dips.
void add_hcp_layer(Lattice& lattice, const LatticePlace& most, int k) {
  const int dip = odd(k) ? 1 : 0;
  const int rows = most[1] / 3 + 1;
  for (int row = -rows; row <= rows; ++row) {
    const int j = 3 * row + dip;
    if (std::abs(j) > most[1]) continue;
    const int from = odd(most[0]) == odd(row + dip) ? -most[0] : -most[0] + 1;
    if (from <= most[0]) lattice.rows.push_back({{from, j, k}, (most[0] - from) / 2 + 1});
  }
}

}  // namespace

Vec3 Lattice::site(const LatticeRow& row, int n) const {
  const Vec3 steps(row.first[0] + n * along[0], row.first[1] + n * along[1],
                   row.first[2] + n * along[2]);
  return centre + unit.cwiseProduct(steps);
}

Lattice lattice_in(const Box& box, Packing packing, double radius) {
  const bool fcc = packing == Packing::fcc;
  Lattice lattice;
  lattice.centre = box.center();
  lattice.unit = fcc ? Vec3::Constant(half_plane_spacing(radius))
                     : Vec3(radius, radius / std::sqrt(3.0), radius * std::sqrt(8.0 / 3));
  lattice.along = fcc ? LatticePlace{1, 1, 0} : LatticePlace{2, 0, 0};
  const LatticePlace most = reach(box, lattice.unit);
  for (int k = -most[2]; k <= most[2]; ++k)
    fcc ? add_fcc_layer(lattice, most, k) : add_hcp_layer(lattice, most, k);
  return lattice;
}

LatticeSize lattice_size(const Box& box, double radius) {
  const Vec3 layers = box.sizes() / half_plane_spacing(radius) + Vec3::Ones();
  return {layers.prod() / 2, layers.z() * (layers.x() + layers.y())};
}

}  // namespace sinew
