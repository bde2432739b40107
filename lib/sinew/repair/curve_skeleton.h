// SPDX-License-Identifier: GPL-3.0-or-later
// The curve skeleton of a body: its skin contracted to curves along its limbs, by CGAL's mean
// curvature flow (Tagliasacchi, Alhashim, Olson and Zhang 2012).
//
//     const CurveGraph graph = curve_skeleton(surface.triangles);
#pragma once

#include <sinew/core/curve_graph.h>
#include <sinew/core/triangles.h>

namespace sinew {

/// Finds the skeleton of every part of the surface that is closed. Surfaces that CGAL does not take
/// as they are (open, with crowded edges, parts that overlap) are closed, then wrapped: gaps
/// narrower than a few hundredths of the size may close. Some thousand even faces are made of any
/// surface before, so that the time, some seconds, does not depend on it. Pieces below a hundredth
/// of the largest are left out, and all but the 40 largest. Parts that contract to a point have one
/// point and no links. The same for any number of threads. Throws bad input where none of this
/// gives a closed surface, or one of more than 40 handles.
CurveGraph curve_skeleton(const Triangles& surface);

}  // namespace sinew
