// SPDX-License-Identifier: GPL-3.0-or-later
#include "fill/inside/body_numbers.h"

#include "core/union_find.h"

namespace sinew {

void number_bodies(const std::vector<SweptRows>& found, const Surface& surface,
                   InsideRuns& inside) {
  UnionFind sets(surface.components);
  for (const SweptRows& piece : found)
    for (const auto& [a, b] : piece.overlaps) sets.join(a, b);
  std::vector<bool> filled(surface.components);
  const std::vector<double> volumes = component_volumes(surface);
  for (int i = 0; i < surface.components; ++i) filled[i] = volumes[i] > 0;
  for (const Run& run : inside.runs) filled[run.body] = true;
  inside.body_of.assign(surface.components, -1);
  for (int i = 0; i < surface.components; ++i) {
    if (!filled[i]) continue;
    int& first = inside.body_of[sets.first_of(i)];
    if (first < 0) first = inside.bodies++;
    inside.body_of[i] = first;
  }
  for (Run& run : inside.runs) run.body = inside.body_of[run.body];
}

}  // namespace sinew
