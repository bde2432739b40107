// SPDX-License-Identifier: GPL-3.0-or-later
// What a user may ask for when a mesh is not the skin of a body yet. Neither is done unasked: both
// make up a surface that the mesh does not have.
#pragma once

#include <cstddef>

#include <sinew/core/triangles.h>

namespace sinew {

struct HoleClosing {
  Triangles triangles;           ///< points and faces as given, in their order, then the new faces
  std::size_t holes_closed = 0;  ///< loops of open edges
  std::size_t faces_added = 0;
};

/// Covers every hole with faces over its own points, so that no edge is left open (mesh/surface.h
/// says what open is). By CGAL: the triangulation that bends least, then of least area (Liepa 2003;
/// Barequet and Sharir 1995), among the triangles of a Delaunay triangulation. A loop it finds none
/// for, or of over 1,000 edges, is cut in two first. Any triangles will do. Faces should agree in
/// direction: an edge along which two go the same way is open, too. Of a sheet (a face, a Moebius
/// strip) the border is closed all the same: it then encloses little or nothing.
HoleClosing close_holes(const Triangles& surface);

/// A closed skin around the faces, with no edge open, that does not cut itself: CGAL's alpha wrap
/// (Portaneri et al. 2022). It bridges gaps narrower than about `alpha` (m), leaves out cavities,
/// and lies alpha / 30 outside of the mesh, as CGAL advises: it makes a body that much fatter, and
/// rounds dents narrower than alpha. Its faces measure about alpha.
///
/// Throws Error (bad input): no face with an area; alpha > 0 not below the box's diagonal; a skin
/// of more than 2 million faces to be expected; or a skin without an inside, which has leaked
/// through a hole wider than alpha.
Triangles wrap(const Triangles& surface, double alpha);

}  // namespace sinew
