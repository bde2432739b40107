// SPDX-License-Identifier: GPL-3.0-or-later
// Which faces meet at which edges, and what follows: holes, shells, directions that agree.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/triangles.h"

namespace sinew {

/// One side of a face, as an undirected edge low-high.
struct EdgeUse {
  int low, high;  ///< points
  int face;
  bool forward;  ///< whether the face goes from low to high
};

/// Every side of every face, sorted by edge and then by face.
std::vector<EdgeUse> edge_uses(const std::vector<std::array<int, 3>>& faces);

/// Calls visit(span) for the uses of each edge.
template <class Visit>
void for_each_edge(std::span<const EdgeUse> uses, Visit&& visit) {
  for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
    while (end < uses.size() && uses[end].low == uses[begin].low &&
           uses[end].high == uses[begin].high)
      ++end;
    visit(uses.subspan(begin, end - begin));
  }
}

/// Throws Error (bad input) unless each edge has exactly two faces.
void refuse_open(const Triangles& surface, std::span<const EdgeUse> uses);

/// Faces joined by edges.
struct Shells {
  std::vector<int> of_face;  ///< shell of each face; shells are numbered by their first face
  std::vector<bool> turned;  ///< faces to reverse for all of a shell to turn like its first face
  int count = 0;
};

/// Throws Error (bad input) where no choice of directions agrees. Each edge must have two faces.
Shells shells_of(const Triangles& surface, std::span<const EdgeUse> uses);

}  // namespace sinew
