// SPDX-License-Identifier: GPL-3.0-or-later
// Verifies a filling: every site of the lattice is checked against CGAL.
//
//     const Verification result = verify(filled.lattice, surface, filled.inside);
#pragma once

#include <memory>

#include <sinew/core/triangles.h>
#include <sinew/fill/fill_report.h>
#include <sinew/fill/inside_runs.h>

namespace sinew {

// The side of a closed surface that a point is on, by CGAL's Side_of_triangle_mesh: one exact query
// per point. Slower than the sweep along rows, and independent of it.

enum class Side { outside, boundary, inside };

class SideOf {
 public:
  /// Builds the search tree. The surface must be closed. Faces without area are left out: they do
  /// not change the result, and CGAL's rays fail on them. Where parts of the surface overlap CGAL
  /// counts crossings modulo 2.
  explicit SideOf(const Triangles& surface);
  ~SideOf();
  SideOf(const SideOf&) = delete;  // CGAL's test must not be moved in memory
  SideOf& operator=(const SideOf&) = delete;

  /// May be called from many threads at once.
  Side side(const Vec3& point) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

/// Throws Error (bad input) unless the surface is closed.
void refuse_unverifiable(const Surface& surface);

/// Compares the sites inside with CGAL's Side_of_triangle_mesh. Throws as refuse_unverifiable()
/// does. Where parts of the surface overlap mismatches are to be expected: CGAL counts crossings
/// modulo 2.
Verification verify(const Lattice& lattice, const Surface& surface, const InsideRuns& inside);

}  // namespace sinew
