// SPDX-License-Identifier: GPL-3.0-or-later
// Where the lattice lies in the mesh's space: it may be turned, and a mesh far from the origin is
// filled near it, where coordinates have more digits.
#pragma once

#include "core/triangles.h"

namespace sinew {

class Placement {
 public:
  /// `turn`: the lattice's axes as columns. Meshes farther from the origin than they are large are
  /// shifted, by an amount that loses no digit of theirs.
  Placement(const Points& points, const Mat3& turn);

  Triangles to_lattice(Triangles surface) const;
  Vec3 to_lattice(const Vec3& point) const;
  Vec3 from_lattice(const Vec3& site) const;

 private:
  Vec3 shift_ = Vec3::Zero();
  Mat3 turn_;
  bool turned_;
};

}  // namespace sinew
