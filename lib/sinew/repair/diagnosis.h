// SPDX-License-Identifier: GPL-3.0-or-later
// Diagnoses a surface beyond what cleaning needs: self-intersections and thin parts, for reports.
// Slower than cleaning: seconds for a million faces.
//
//     const Defects defects = defects_of(surface, diagnose(surface));
#pragma once

#include <optional>
#include <vector>

#include <sinew/mesh/surface.h>
#include <sinew/repair/self_intersections.h>

namespace sinew {

struct Diagnosis {
  SelfIntersections intersections;
  std::optional<double> thinnest;  ///< 1st percentile of the thickness, m; none: no inside
};

Diagnosis diagnose(const Surface& surface);

// The defects of a surface, as geometry to be drawn over it.

enum class EdgeDefect {
  open,     ///< edge of one face
  crowded,  ///< edge of three faces or more
  twisted,  ///< edge of two faces that cannot be oriented consistently
};

struct DefectiveEdge {
  int a, b;  ///< points of the surface
  EdgeDefect defect;
  int hole;  ///< the first hole (a loop of the border, from 0) it belongs to; -1: it is closed
};

struct Defects {
  std::vector<bool> turned;        ///< per face: reversed with respect to the file
  std::vector<bool> intersecting;  ///< per face: takes part in a self-intersection found
  std::vector<bool> flat;          ///< per face: has no area
  std::vector<DefectiveEdge> edges;
};

/// Surface::component gives the connected components of faces.
Defects defects_of(const Surface& surface, const Diagnosis& diagnosis);

}  // namespace sinew
