// SPDX-License-Identifier: GPL-3.0-or-later
// What is wrong with a surface, as geometry to be drawn over it.
#pragma once

#include <vector>

#include "mesh/diagnosis.h"
#include "mesh/surface.h"

namespace sinew {

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
