// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/diagnosis.h"

#include "mesh/thickness.h"

namespace sinew {

Diagnosis diagnose(const Surface& surface) {
  return {self_intersections(surface.triangles), thinnest_part(surface.triangles)};
}

}  // namespace sinew
