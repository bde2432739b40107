// SPDX-License-Identifier: GPL-3.0-or-later
// The body as tetrahedra whose vertices are its particles. A closest packing has such a mesh for
// free: its sites are the vertices of the tetrahedral-octahedral honeycomb, two regular tetrahedra
// and an octahedron per site, which is split into four along a diagonal. So nothing can fail
// inside, whatever the surface is. At the border sites just outside are added, those near the
// surface are moved onto it, and tetrahedra are cut where it crosses their edges (isosurface
// stuffing: Labelle and Shewchuk 2007, on this honeycomb instead of a BCC lattice). Particles of
// packings that are no lattice are joined by Delaunay tetrahedra instead.
//
//     const VolumeCells body = volume_cells(surface, options, rest);
//     const CellQuality quality = quality_of(body);
//
// The surface may be anything that can be filled: inside is where its winding number exceeds 1/2,
// or the layer along it where a thickness is given.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <sinew/core/dataset.h>
#include <sinew/core/vector.h>
#include <sinew/core/volume_mesh.h>
#include <sinew/fill/pack.h>
#include <sinew/mesh/surface.h>

namespace sinew {

/// Vertices of a tetrahedron; its volume (b - a) x (c - a) . (d - a) / 6 is positive at rest.
using Cell = std::array<std::uint32_t, 4>;

struct VolumeCells {
  Points points;                 ///< at rest, n x 3, m
  std::vector<std::int32_t> id;  ///< id of the particle that is exactly there; -1: another point
  /// Particle there or, at another point, one beside it: whose place it was moved from,
  /// or on whose edge it lies; -1 where there is none.
  std::vector<std::int32_t> beside;
  std::vector<Cell> cells;  ///< any two share a face, an edge, a vertex or nothing
};

/// The cells of particles at `rest` (m, by id), which pack() has placed with these options but for
/// the radius, which is needed. Bodies that share no particle share no vertex. The same for any
/// number of threads. Throws bad input where no particle is left.
VolumeCells volume_cells(const Surface& surface, const PackOptions& options, const Points& rest);

/// The cells as finite elements of four nodes.
VolumeMesh mesh_of(const VolumeCells& body);

/// Six times the volume of a cell is the determinant; m^3.
inline double volume_of(const Points& points, const Cell& cell) {
  const Vec3 &a = points[cell[0]], &b = points[cell[1]], &c = points[cell[2]], &d = points[cell[3]];
  return (b - a).cross(c - a).dot(d - a) / 6;
}

/// The smallest and the largest angle between two faces of a tetrahedron, degrees.
struct DihedralAngles {
  double smallest = 180, largest = 0;
};
DihedralAngles dihedral_angles(const std::array<Vec3, 4>& corners);

struct CellQuality {
  double volume = 0;           ///< volume of all cells, m^3
  double smallest_volume = 0;  ///< volume of the smallest cell, m^3
  DihedralAngles angles;       ///< over all cells
};
CellQuality quality_of(const VolumeCells& body);

/// The cells at rest, with `id`.
Dataset dataset_of(const VolumeCells& body);

}  // namespace sinew
