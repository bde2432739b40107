// SPDX-License-Identifier: GPL-3.0-or-later
// Cuts tetrahedra along the border of a body, without slivers (Labelle and Shewchuk 2007): points
// to which a crossing of one of their edges is near are moved there first, so that what is cut
// afterward is cut far from its corners.
//
//     const VolumeCells body = stuffed(honeycomb.around(0), border_of(space), radius);
#pragma once

#include <functional>

#include <sinew/volume/detail/scaffold.h>
#include <sinew/volume/volume_cells.h>

namespace sinew {

/// Fractions of an edge up to which a crossing is near: of edges between touching particles, and of
/// longer ones. Those with the largest smallest angle along planes of any direction.
struct NearFractions {
  double touching = 0.35, longer = 0.27;
};

/// Where a body ends.
struct BodyBorder {
  std::function<bool(const Vec3& point)> contains;  ///< what is inside
  /// Where the segment between a point inside and one outside leaves it, as a fraction of it.
  std::function<double(const Vec3& inside, const Vec3& outside)> crossing;
};

/// In the scaffold's coordinates; ids are those of its particles. `radius` in m.
VolumeCells stuffed(const Scaffold& scaffold, const BodyBorder& border, double radius,
                    const NearFractions& near = {});

}  // namespace sinew
