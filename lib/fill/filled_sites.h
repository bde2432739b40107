// SPDX-License-Identifier: GPL-3.0-or-later
// Which sites of a lattice become particles.
#pragma once

#include "fill/inside_runs.h"
#include "fill/pack_options.h"
#include "fill/placement.h"

namespace sinew {

/// A surface in the space of its lattice.
struct BodySpace {
  BodySpace(const Surface& given, const PackOptions& options);

  Placement placement;
  Surface surface;
  Box box;  ///< that the lattice fills
  std::optional<Vec3> lattice_origin;
};

struct FilledSites {
  Lattice lattice;
  InsideRuns inside;      ///< empty where a layer is filled
  std::vector<Run> runs;  ///< of those inside the ones that are kept, or the layer
};

/// Sites at about `radius` (m): exactly, but where a count is wanted of a volume that is not known
/// beforehand.
FilledSites fill_sites(const BodySpace& space, const PackOptions& options, double radius);

std::size_t count_of(const std::vector<Run>& runs);

/// How far within the body a centre has to lie, m.
double clearance_of(const PackOptions& options, double radius);

/// A lattice over a box, just fine enough to judge a surface by.
Lattice coarse_lattice(const Box& box);

}  // namespace sinew
