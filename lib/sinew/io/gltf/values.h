// SPDX-License-Identifier: GPL-3.0-or-later
// The numbers an accessor stands for.
#pragma once

#include <string>
#include <vector>

#include <sinew/io/gltf/guard.h>

namespace sinew {

/// All components of all elements, element by element; normalized ones as parts of the largest
/// whole number, from -1 or 0 to 1. The accessor must have passed the guard and have data. Throws
/// bad input (without the path) where a number is not finite: "USER hold a number that is not
/// finite".
std::vector<double> gltf_values(const GuardedGltf& gltf, int accessor, const std::string& user);

}  // namespace sinew
