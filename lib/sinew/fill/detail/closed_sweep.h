// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the sites inside a closed surface, whose winding number along a row is an integer that
// changes at crossings only.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include <sinew/fill/inside_runs.h>
#include <sinew/fill/lattice.h>
#include <sinew/fill/row_crossings.h>
#include <sinew/fill/runs.h>
#include <sinew/mesh/surface.h>

namespace sinew {

/// Numbers the bodies of a closed surface: joins overlapping components, and numbers those that
/// enclose a volume or contain sites by their first component.
void number_bodies(const std::vector<SweptRows>& found, const Surface& surface, InsideRuns& inside);

/// The winding numbers of the components at one point of a row.
class Depths {
 public:
  void cross(int component, int winding) {
    const auto at = find(component);
    if (at == depths_.end() || (*at)[0] != component) {
      depths_.insert(at, {component, winding});
      entered_.push_back(component);
    } else if (((*at)[1] += winding) == 0) {
      depths_.erase(at);
    }
  }

  /// Components of nonzero winding number.
  const std::vector<std::array<int, 2>>& around() const { return depths_; }

  /// The first component around this point. Those entered since the last call that are also around
  /// it are recorded as overlapping with another one.
  int body(std::vector<std::array<int, 2>>& overlaps) {
    const auto positive = [](const std::array<int, 2>& depth) { return depth[1] > 0; };
    const auto first = std::find_if(depths_.begin(), depths_.end(), positive);
    if (first == depths_.end()) return 0;  // not where the sum of all is positive
    const auto second = std::find_if(first + 1, depths_.end(), positive);
    for (const int component : entered_)
      if (second != depths_.end() && depth_of(component) > 0)
        overlaps.push_back({(*first)[0], component == (*first)[0] ? (*second)[0] : component});
    entered_.clear();
    return (*first)[0];
  }

 private:
  std::vector<std::array<int, 2>>::iterator find(int component) {
    return std::lower_bound(
        depths_.begin(), depths_.end(), component,
        [](const std::array<int, 2>& depth, int wanted) { return depth[0] < wanted; });
  }

  int depth_of(int component) {
    const auto at = find(component);
    return at != depths_.end() && (*at)[0] == component ? (*at)[1] : 0;
  }

  std::vector<int> entered_;                ///< since body() was called
  std::vector<std::array<int, 2>> depths_;  ///< component and winding number, not 0
};

/// Calls visit(component, winding) for the component that a row leaves at a crossing, and for the
/// one that it enters: both at a wall, whose number follows those of the faces.
template <class Visit>
void for_each_component(const Surface& surface, const Crossing& one, Visit&& visit) {
  const auto faces = static_cast<int>(surface.triangles.faces.size());
  if (one.face < faces) return visit(surface.component[one.face], one.winding);
  const auto& [behind, before] = surface.walls.component[one.face - faces];
  visit(one.winding > 0 ? before : behind, -1);
  visit(one.winding > 0 ? behind : before, 1);
}

/// Per component: itself, or for a cavity the component whose body it is in.
std::vector<int> owners_of(const Surface& surface, const RowCrossings& crossings);

class ClosedSweep {
 public:
  /// All arguments must outlive this. `crossings` are those of the surface and its walls.
  ClosedSweep(const Lattice& lattice, const Surface& surface, const RowCrossings& crossings);

  /// Adds the row's sites inside, in runs of the first component around them.
  void add_row(std::size_t row, SweptRows& found) const;

 private:
  const Lattice& lattice_;
  const Surface& surface_;
  const RowCrossings& crossings_;
  std::vector<int> owner_;  ///< owner of each component, where there are several
};

}  // namespace sinew
