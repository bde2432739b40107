// SPDX-License-Identifier: GPL-3.0-or-later
// Tetrahedra that cover a body and reach beyond it: what its border is then cut from.
//
//     const Scaffold scaffold = honeycomb(space, options, rest, body);
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <sinew/core/vector.h>
#include <sinew/fill/filled_sites.h>
#include <sinew/volume/detail/inside_space.h>
#include <sinew/volume/volume_cells.h>

namespace sinew {

struct Scaffold {
  Points points;                       ///< m, in the lattice's coordinates
  std::vector<char> inside;            ///< one per point: whether it is in the body
  std::vector<std::int32_t> particle;  ///< there, -1 for none
  std::vector<Cell> cells;             ///< each with a point inside, of either orientation
};

/// The sites of a lattice around a body, with the particles on them.
class Honeycomb {
 public:
  /// `rest` in the lattice's coordinates, m.
  Honeycomb(const BodySpace& space, const PackOptions& options, const Points& rest);

  /// The sites of a lattice that lie `inside` of anything else, without particles.
  Honeycomb(Lattice lattice, const std::function<bool(const Vec3& site)>& inside);

  /// 1 but for closed surfaces of several bodies that share no site.
  int bodies() const { return bodies_; }
  /// The faces of a body and of all cavities.
  Surface faces_of(const Surface& surface, int body) const;
  /// Two tetrahedra and an octahedron, in four, per site, where they touch a site inside.
  Scaffold around(int body) const;

 private:
  explicit Honeycomb(Lattice lattice);
  std::int64_t site_at(const LatticePlace& place) const;
  LatticePlace place_of(const Vec3& point) const;
  void take_inside(const std::function<bool(const Vec3& site)>& inside);
  void find_inside(const BodySpace& space, const PackOptions& options);

  Lattice lattice_;
  std::vector<std::int64_t> first_;     ///< site of each row, and their number
  std::vector<std::int32_t> body_;      ///< body that each site is in, -1 for none
  std::vector<std::int32_t> particle_;  ///< at each site, -1 for none
  std::vector<int> body_of_;            ///< body of each component of a closed surface
  int bodies_ = 1;
};

/// Delaunay tetrahedra of particles at `rest` (m), without edges beyond the range of neighbors, and
/// of their images behind the surface nearby.
Scaffold delaunay(const Points& rest, double radius, const InsideSpace& space);

}  // namespace sinew
