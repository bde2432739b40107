// SPDX-License-Identifier: GPL-3.0-or-later
// Repairs of a mesh that is not yet the skin of a body, done only on request: both add a surface
// that the mesh does not have.
//
//     const Triangles closed = close_holes(surface).triangles;
//     const Triangles skin = wrap(surface, 0.01);
#pragma once

#include <cstddef>

#include <sinew/core/triangles.h>

namespace sinew {

struct HoleClosing {
  Triangles triangles;           ///< points and faces as given, in their order, then the new faces
  std::size_t holes_closed = 0;  ///< loops of open edges
  std::size_t faces_added = 0;
};

/// Covers every hole with faces on its own points, so that no edge is left open
/// (<sinew/mesh/border.h> defines open). By CGAL: the triangulation that bends least, then of least
/// area (Liepa 2003; Barequet and Sharir 1995), among the triangles of a Delaunay triangulation. A
/// loop without one, or of more than 1,000 edges, is first cut in two. Accepts any triangles. Their
/// orientations should agree: an edge that two faces traverse in the same direction is open, too.
/// The border of a sheet (a face, a Moebius strip) is closed as well and then encloses little or
/// nothing.
HoleClosing close_holes(const Triangles& surface);

/// A closed skin around the faces without self-intersections: CGAL's alpha wrap (Portaneri et al.
/// 2022). It bridges gaps narrower than about `alpha` (m), omits cavities, and lies alpha / 30
/// outside the mesh, as CGAL recommends: the body grows by that much, and dents narrower than alpha
/// are rounded. Its faces are about alpha in size.
///
/// Throws Error (bad input) where no face has an area, where alpha is not above 0 and below the
/// box's diagonal, where a skin of more than 2 million faces is expected, and for a skin without an
/// inside, which has leaked through a hole wider than alpha.
Triangles wrap(const Triangles& surface, double alpha);

}  // namespace sinew
