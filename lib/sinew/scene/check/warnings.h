// SPDX-License-Identifier: GPL-3.0-or-later
// What is doubtful in a scene that can be run all the same.
//
//     for (const std::string& warning : warnings_of(prepared, speed)) print(warning);
#pragma once

#include <string>
#include <vector>

#include <sinew/scene/prepare.h>

namespace sinew {

/// One line each, with the number, the reason and the cure. `surface`: of the body; `bone_speed` in
/// radii per step.
std::vector<std::string> warnings_of(const Prepared& prepared, double bone_speed);

/// Adds a line where the body is one or two layers of particles thick, where limbs touch at rest
/// across a gap of the mesh, and where limbs that do not belong together meet in the motion of a
/// material that sticks to itself.
void warn_of_contacts(const Prepared& prepared, std::vector<std::string>& warnings);

/// How stiff the filled body is along a bone, beside the Young's modulus that was asked for.
struct BoneStiffness {
  std::string bone;
  double young_modulus;  ///< of the material along the bone, Pa
  double planes;         ///< half-planes of particles across the body there
  double lack;           ///< fraction of the bending stiffness that so few of them lack, at most

  /// Returns the modulus that a bending body shows, Pa.
  double bending_modulus() const { return young_modulus * (1 - lack); }
};

/// Finds the stiffness along each bone that holds particles.
std::vector<BoneStiffness> stiffness_along_bones(const Body& body);

/// Adds a line where a bending body shows another modulus than that, by over 10 % at some bone.
void warn_of_stiffness(const Body& body, std::vector<std::string>& warnings);

}  // namespace sinew
