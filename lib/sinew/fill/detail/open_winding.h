// SPDX-License-Identifier: GPL-3.0-or-later
// The generalized winding number (Jacobson et al. 2013) of a surface with holes, along the rows of
// a lattice. With its caps the surface is closed, so signed crossings give an integer; the
// contribution of the caps is then subtracted:
//   w(q) = crossings of the surface before q + sum over caps of S(q),
//   S(q) = 1 / (4 pi) sum over a cap's sides ab of 2 atan2(D, N),  with A = a - q, B = b - q,
//   D = A_v B_w - A_w B_v,  N = |A||B| + A.B + A_u |B| + B_u |A|,
// (u along the row, v across, w up): the solid angle of the strips that extend from the cap's sides
// backward along the row. S jumps only on those strips, where no row lies. It is also the signed
// crossing of the cap before q less the cap's solid angle: so for all caps, those nearby one by one
// (by one arc tangent), distant ones combined in a tree, with a bound on the error. Where that
// bound is too large each cap is evaluated by its strips, right also for points in its plane.
#pragma once

#include <array>
#include <vector>

#include <sinew/core/triangles.h>
#include <sinew/fill/detail/cap_tree.h>
#include <sinew/fill/lattice.h>
#include <sinew/fill/row_crossings.h>
#include <sinew/fill/runs.h>
#include <sinew/mesh/surface.h>

namespace sinew {

class OpenWinding {
 public:
  /// All arguments must outlive this. `crossings` are those of the caps.
  OpenWinding(const Lattice& lattice, const Triangles& caps, const RowCrossings& crossings);

  bool none() const { return sorted_.empty(); }

  struct Contribution {
    double value;      ///< contribution of the caps to the winding number
    double clearance;  ///< lower bound on the distance to the border, m
  };

  /// At a site, in full precision.
  Contribution contribution(std::size_t row, int site) const;

  /// Required accuracy of a contribution: `doubt`, or a third of its distance from `threshold`.
  struct Enough {
    double doubt;
    double threshold;
  };
  Contribution contribution(std::size_t row, int site, const Enough& enough) const;

 private:
  struct Cap {
    CapCorners corners;
    std::array<bool, 3> border;  ///< which sides are the surface's border, not another cap's side
    double half_side;            ///< half of the longest side
    int face;
  };
  struct View;  ///< one site with its row
  struct Ray;

  void find_border();
  View view(std::size_t row, int site) const;
  Contribution sum(const View& view, double farness, double& doubt) const;
  void add_near(const View& view, int place, Contribution& sum) const;
  int before(const View& view) const;
  int before(const View& view, int face) const;
  Contribution strips(const View& view, const Cap& cap) const;
  Ray ray(const View& view, const Vec3& corner) const;
  double turn(const View& view, const Cap& cap, int corner, const Ray& a, const Ray& b) const;

  const Lattice& lattice_;
  const Triangles& caps_;
  const RowCrossings& crossings_;
  RowFrame frame_;
  RowSide side_;
  CapTree tree_;
  std::vector<Cap> sorted_;  ///< in the order of the tree
};

// Finds the sites inside an open surface, whose winding number along a row jumps at crossings and
// varies smoothly between them, by the contribution of the caps.

class OpenSweep {
 public:
  /// All arguments must outlive this. `crossings` are those of the surface without its caps.
  OpenSweep(const Lattice& lattice, const Surface& surface, const RowCrossings& crossings);

  /// Adds the row's sites inside, in runs of body 0.
  void add_row(std::size_t row, SweptRows& found) const;

  /// At a site, with an error of a few hundredths.
  double winding(std::size_t row, int site) const;

 private:
  void add_between(std::size_t row, int first, int last, int sum, RowRuns& runs) const;

  const Lattice& lattice_;
  const RowCrossings& crossings_;
  RowCrossings cap_crossings_;
  OpenWinding winding_;
};

}  // namespace sinew
