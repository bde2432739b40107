// SPDX-License-Identifier: GPL-3.0-or-later
// The promise that a filling is right, in the user's hand: every site of the lattice asked of CGAL.
#pragma once

#include "fill/fill_report.h"
#include "fill/inside/inside_runs.h"

namespace sinew {

/// Throws Error (bad input) unless the surface is closed.
void refuse_unverifiable(const Surface& surface);

/// Compares the sites inside with CGAL's Side_of_triangle_mesh. Throws as refuse_unverifiable()
/// does. Where parts of the surface overlap mismatches are to be expected: CGAL counts crossings
/// modulo 2.
Verification verify(const Lattice& lattice, const Surface& surface, const InsideRuns& inside);

}  // namespace sinew
