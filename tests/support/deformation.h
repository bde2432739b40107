// SPDX-License-Identifier: GPL-3.0-or-later
// Deformation gradients of all particles of a body.
#pragma once

#include <vector>

#include <sinew/core/deformation.h>

namespace sinew::test {

inline std::vector<Mat3> deformation_gradients(const RestShape& rest, const Points& now) {
  std::vector<Mat3> gradients;
  for (std::size_t i = 0; i < now.size(); ++i)
    gradients.push_back(deformation_gradient(rest, now, i));
  return gradients;
}

}  // namespace sinew::test
