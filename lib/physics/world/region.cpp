// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/world/region.h"

#include <cmath>

#include "core/error.h"
#include "core/number_text.h"

namespace sinew {

double Region::weight(const Vec3& point) const {
  if (!shape) return 1;
  if (falloff > 0 && !may_be_within(*shape, point, falloff)) return 0;
  const double distance = signed_distance(*shape, point).distance;
  if (distance <= 0) return 1;
  if (!(distance < falloff)) return 0;
  const double s = 1 - distance / falloff;
  return s * s * (3 - 2 * s);
}

void check_region(const Region& region, const std::string& what) {
  if (region.shape) check_shape(*region.shape, what);
  if (!std::isfinite(region.falloff) || region.falloff < 0)
    throw bad_input(what + " has a falloff of " + number_text(region.falloff),
                    "give 0 or a positive width");
}

}  // namespace sinew
