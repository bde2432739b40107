// SPDX-License-Identifier: GPL-3.0-or-later
// The sites of closest packings (FCC, HCP) in a box, as rows along a close-packed direction, in
// which the spacing is 2r. By default a site lies at the box's center, so that a symmetric body is
// filled symmetrically and no layer lies on the faces of a box.
//
//     const Lattice lattice = lattice_in(box, Packing::fcc, radius);
//
// Every coordinate of every site is an integer multiple of one power of two, the smallest that
// doubles resolve at the box's farthest corner: sums and differences of sites are exact, and the
// sites of a row lie exactly on a line, so that exact predicates apply to whole rows. Spacings are
// rounded up: no two sites are closer than 2r, and sites that would lie on the faces of a box do
// not get inside by rounding.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <sinew/core/options.h>
#include <sinew/core/triangles.h>
#include <sinew/core/vector.h>

namespace sinew {

using LatticePlace = std::array<int, 3>;  ///< a site in steps of Lattice::unit from the origin

struct LatticeRow {
  LatticePlace first;
  int sites;
};

/// The rows of one layer z = origin.z + k unit.z: evenly spaced across.
struct LatticeLayer {
  std::size_t first_row;  ///< index into Lattice::rows
  int rows;
  int across;  ///< place of the first row across; each next one is 2 (FCC) or 3 (HCP) farther
};

struct Lattice {
  Packing packing;
  double radius;                 ///< radius of the particles, m
  Vec3 origin;                   ///< a site, m
  Vec3 unit;                     ///< m; FCC: sites are where i + j + k is even, of step sqrt(2) r
  LatticePlace along;            ///< steps from a site to the next of its row
  LatticePlace low, high;        ///< limits of i, j, k
  std::vector<LatticeRow> rows;  ///< rows by z, then across: a fixed order
  std::vector<LatticeLayer> layers;  ///< layers k = low[2] .. high[2]

  /// Site n of a row, m; exact for any n near the row, also beyond its ends.
  Vec3 site(const LatticeRow& row, int n) const {
    return {origin[0] + unit[0] * (row.first[0] + n * along[0]),
            origin[1] + unit[1] * (row.first[1] + n * along[1]),
            origin[2] + unit[2] * row.first[2]};
  }

  Vec3 site(std::int32_t row, int n) const { return site(rows[row], n); }

  /// The row with that k and `across` (FCC: i - j, HCP: j), or -1.
  std::int64_t row_at(int k, int across) const;

  /// The steps to the 12 nearest sites, from a site of layer k.
  std::span<const LatticePlace, 12> nearest(int k) const;

  std::uint64_t sites() const;
};

/// All sites within the box (not empty; a size below 1e9 r) and on its surface, for radius r > 0
/// (m). A site lies at `origin`, by default the box's center (rounded as above). All coordinates
/// are multiples of a power of two, of `step` (m) where that is larger.
Lattice lattice_in(const Box& box, Packing packing, double radius,
                   const std::optional<Vec3>& origin = std::nullopt, double step = 0);

/// Estimated numbers of sites and rows.
struct LatticeSize {
  double sites, rows;
};
LatticeSize lattice_size(const Box& box, double radius);

// The placement of the lattice with respect to the mesh: it may be rotated, and a mesh far from the
// origin is filled near it, where coordinates have more digits.

class LatticeFrame {
 public:
  /// `turn`: the lattice's axes as columns. Meshes farther from the origin than their size are
  /// shifted, by an amount that loses no digits.
  LatticeFrame(const Points& points, const Mat3& turn);

  Triangles to_lattice(Triangles surface) const;
  Vec3 to_lattice(const Vec3& point) const;
  Vec3 from_lattice(const Vec3& site) const;

  /// Far from the origin, the step (m) of coordinates that are moved back exactly, so that
  /// neighbors there are as far apart as here; else 0.
  double step() const { return step_; }

 private:
  double step_ = 0;
  Vec3 shift_ = Vec3::Zero();
  Mat3 turn_;
  bool turned_;
};

}  // namespace sinew
