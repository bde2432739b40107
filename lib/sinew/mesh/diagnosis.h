// SPDX-License-Identifier: GPL-3.0-or-later
// What cleaning does not need to know, but people want to be told. Takes longer than cleaning:
// seconds for a million faces.
#pragma once

#include <optional>
#include <vector>

#include <sinew/mesh/self_intersections.h>
#include <sinew/mesh/surface.h>

namespace sinew {

struct Diagnosis {
  SelfIntersections intersections;
  std::optional<double>
      thinnest;  ///< thickness below which 1 % of the skin lies, m; none: no inside
};

Diagnosis diagnose(const Surface& surface);

// What is wrong with a surface, as geometry to be drawn over it.

enum class EdgeDefect {
  open,     ///< of one face
  crowded,  ///< of three faces or more
  twisted,  ///< of two faces that cannot agree
};

struct DefectiveEdge {
  int a, b;  ///< points of the surface
  EdgeDefect defect;
  int hole;  ///< the first hole (a loop of the border, from 0) it belongs to; -1: it is closed
};

struct Defects {
  std::vector<bool> turned;        ///< per face: points against the file
  std::vector<bool> intersecting;  ///< per face: takes part in a self-intersection found
  std::vector<bool> flat;          ///< per face: has no area
  std::vector<DefectiveEdge> edges;
};

/// Surface::component tells which faces hang together.
Defects defects_of(const Surface& surface, const Diagnosis& diagnosis);

}  // namespace sinew
