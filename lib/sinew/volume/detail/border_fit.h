// SPDX-License-Identifier: GPL-3.0-or-later
// Cells whose corners lie on a curved surface lack the volume between their faces and the surface:
// of a ball ten layers across 1.3 %. The border is moved outward, or inward where it is concave, by
// the mean of what is missing, so that its faces lie about the surface; plane faces stay.
//
//     fit_border(body, space, radius);
#pragma once

#include <array>
#include <vector>

#include <sinew/volume/detail/inside_space.h>
#include <sinew/volume/volume_cells.h>

namespace sinew {

using BorderFace = std::array<std::uint32_t, 3>;

/// Faces of one cell alone, outward.
std::vector<BorderFace> border_of(const VolumeCells& body);

/// The cells around each point, so that points may be moved as long as no cell becomes flat.
class CellsOfPoint {
 public:
  explicit CellsOfPoint(const VolumeCells& body);

  /// Moves a point to `place`, unless a cell with a smaller angle than `flat` degrees became
  /// flatter by that.
  bool move(VolumeCells& body, std::uint32_t point, const Vec3& place, double flat) const;

 private:
  double smallest_angle(const VolumeCells& body, std::uint32_t point) const;

  std::vector<std::size_t> first_;
  std::vector<std::uint32_t> cells_;
};

/// Moves border points onto creases of the surface, then the others outward. `radius` in m.
void fit_border(VolumeCells& body, const InsideSpace& space, double radius);

}  // namespace sinew
