// SPDX-License-Identifier: GPL-3.0-or-later
// A surface as the fill takes it: triangles that agree on what is outside as far as they can, and
// what closes them where they do not.
#pragma once

#include <cstddef>
#include <vector>

#include "core/triangles.h"
#include "mesh/cleaning_counts.h"

namespace sinew {

/// Where the surface ends. Each edge counts the directions its faces go along it, forward minus
/// backward; where that is not 0 the surface is open. Such edges form closed loops: the holes.
struct Border {
  std::size_t holes = 0;          ///< loops
  std::size_t edges = 0;          ///< open edges
  std::size_t crowded_edges = 0;  ///< edges of three or more faces, open or not
  double length = 0;              ///< of the open edges, m
};

/// The faces of a body point outward (counter-clockwise seen from outside), those of a cavity into
/// the cavity. They may cut each other, and overlap.
struct Surface {
  Triangles triangles;
  std::vector<bool> turned;    ///< per face: whether it points against the file
  std::vector<int> component;  ///< per face: faces joined by edges, numbered by their first face
  int components = 0;
  /// Faces that close every hole, with points of their own, so that triangles and caps together
  /// have no border. They fill nothing; they are a means to compute winding numbers.
  Triangles caps;
  Border border;
  CleaningCounts cleaning;
  double seconds_reading = 0, seconds_cleaning = 0;

  bool closed() const { return caps.faces.empty(); }
};

/// The volume that each component encloses, m^3; negative for cavities. Of open surfaces without
/// the volume behind their caps.
std::vector<double> component_volumes(const Surface& surface);

}  // namespace sinew
