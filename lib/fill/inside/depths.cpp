// SPDX-License-Identifier: GPL-3.0-or-later
#include "fill/inside/depths.h"

#include <numeric>

namespace sinew {
namespace {

constexpr int unknown = -1;

/// The one component around a place that no cavity has taken away, or `unknown`.
int only_one(const Depths& depths) {
  int found = unknown;
  for (const auto& [component, depth] : depths.around()) {
    if (depth <= 0) continue;
    if (found != unknown) return unknown;
    found = component;
  }
  return found;
}

/// Follows a row and finds owners of cavities that have none yet. False when it learnt nothing.
bool learn(std::span<const Crossing> row, const Surface& surface, std::vector<int>& owner) {
  Depths depths;
  bool learnt = false;
  for (const Crossing& one : row) {
    const int component = surface.component[one.face];
    if (owner[component] == unknown && one.winding < 0) {
      owner[component] = only_one(depths);
      learnt = learnt || owner[component] != unknown;
    }
    if (owner[component] == unknown) return learnt;
    depths.cross(owner[component], one.winding);
  }
  return learnt;
}

}  // namespace

std::vector<int> owners_of(const Surface& surface, const RowCrossings& crossings) {
  const std::vector<double> volumes = component_volumes(surface);
  std::vector<int> owner(surface.components);
  std::iota(owner.begin(), owner.end(), 0);
  std::size_t missing = 0;
  for (int i = 0; i < surface.components; ++i)
    if (volumes[i] < 0) owner[i] = unknown, ++missing;
  for (bool learnt = missing > 0;
       learnt && std::count(owner.begin(), owner.end(), unknown) >
                     0;) {  // cavities within cavities take more than one round
    learnt = false;
    for (std::size_t row = 0; row + 1 < crossings.first.size(); ++row)
      learnt = learn(crossings.of(row), surface, owner) || learnt;
  }
  for (int i = 0; i < surface.components; ++i)
    if (owner[i] == unknown) owner[i] = i;
  return owner;
}

}  // namespace sinew
