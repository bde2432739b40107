// SPDX-License-Identifier: GPL-3.0-or-later
// What cleaning does not need to know, but people want to be told. Takes longer than cleaning:
// seconds for a million faces.
#pragma once

#include <optional>

#include "mesh/self_intersections.h"
#include "mesh/surface.h"

namespace sinew {

struct Diagnosis {
  SelfIntersections intersections;
  std::optional<double>
      thinnest;  ///< thickness below which 1 % of the skin lies, m; none: no inside
};

Diagnosis diagnose(const Surface& surface);

}  // namespace sinew
