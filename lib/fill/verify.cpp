// SPDX-License-Identifier: GPL-3.0-or-later
#include "fill/verify.h"

#include <algorithm>

#include "core/error.h"
#include "core/parallel.h"
#include "fill/side_of.h"

namespace sinew {
namespace {

constexpr std::size_t rows_at_a_time = 16;

/// One row against the runs from `next` on, which are moved past it.
Verification verify_row(const Lattice& lattice, std::size_t row, const SideOf& cgal,
                        std::vector<Run>::const_iterator& next,
                        std::vector<Run>::const_iterator end) {
  Verification found;
  for (int n = 0; n < lattice.rows[row].sites; ++n) {
    while (next != end && next->row == static_cast<std::int32_t>(row) && next->last <= n) ++next;
    const bool inside =
        next != end && next->row == static_cast<std::int32_t>(row) && next->first <= n;
    const Side side = cgal.side(lattice.site(lattice.rows[row], n));
    ++found.sites;
    found.on_surface += side == Side::boundary;
    found.mismatches += inside != (side == Side::inside);
  }
  return found;
}

void add(Verification& sum, const Verification& part) {
  sum.sites += part.sites;
  sum.on_surface += part.on_surface;
  sum.mismatches += part.mismatches;
}

}  // namespace

void refuse_unverifiable(const Surface& surface) {
  if (surface.closed()) return;
  throw bad_input("only closed surfaces can be verified, and this one has " +
                      std::to_string(surface.border.edges) + " open edges",
                  "close its holes, or leave the verification out");
}

Verification verify(const Lattice& lattice, const Surface& surface, const InsideRuns& inside) {
  refuse_unverifiable(surface);
  const SideOf cgal(surface.triangles);
  const std::size_t rows = lattice.rows.size();
  std::vector<Verification> pieces((rows + rows_at_a_time - 1) / rows_at_a_time);
  parallel_for(rows, rows_at_a_time, [&](std::size_t begin, std::size_t end) {
    const auto before = [](const Run& run, std::size_t row) {
      return run.row < static_cast<std::int32_t>(row);
    };
    auto next = std::lower_bound(inside.runs.begin(), inside.runs.end(), begin, before);
    for (std::size_t row = begin; row < end; ++row) {
      while (next != inside.runs.end() && before(*next, row)) ++next;
      add(pieces[begin / rows_at_a_time], verify_row(lattice, row, cgal, next, inside.runs.end()));
    }
  });
  Verification sum;
  for (const Verification& piece : pieces) add(sum, piece);
  return sum;
}

}  // namespace sinew
