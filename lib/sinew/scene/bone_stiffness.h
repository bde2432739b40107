// SPDX-License-Identifier: GPL-3.0-or-later
// How stiff the filled body is along each bone, beside the Young's modulus that was asked for.
//
//     for (const BoneStiffness& bone : stiffness_along_bones(body)) ...
#pragma once

#include <string>
#include <vector>

#include <sinew/physics/forces.h>

namespace sinew {

struct BoneStiffness {
  std::string bone;
  double young_modulus;  ///< of the material along the bone, Pa
  double planes;         ///< half-planes of particles across the body there
  double lack;           ///< share of the bending stiffness that so few of them lack, at most

  /// That a bending body shows, Pa.
  double bending_modulus() const { return young_modulus * (1 - lack); }
};

/// Of the bones that hold particles.
std::vector<BoneStiffness> stiffness_along_bones(const Body& body);

}  // namespace sinew
