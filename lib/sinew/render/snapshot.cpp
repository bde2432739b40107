// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/snapshot.h>

#include <algorithm>
#include <cmath>

namespace sinew {

Snapshot marked(const Snapshot& snapshot, Mark mark) {
  Snapshot some;
  some.radius = snapshot.radius;
  for (std::size_t i = 0; i < snapshot.particles.size(); ++i) {
    if ((snapshot.marks.empty() ? Mark::none : snapshot.marks[i]) != mark) continue;
    some.particles.push_back(snapshot.particles[i]);
    some.marks.push_back(mark);
  }
  return some;
}

double ColorScale::position(double value) const {
  if (std::isnan(value)) return value;
  if (!(high > low) || value < low) return 0;
  return std::min(1.0, (value - low) / (high - low));
}

}  // namespace sinew
