// SPDX-License-Identifier: GPL-3.0-or-later
// How stiff a filled body is along its bones and between what holds and pulls it, beside the
// Young's modulus that was asked for: by the direction in its packing, and by its few layers of
// particles.
//
//     for (const BoneStiffness& bone : stiffness_along_bones(body)) print(bone.bending_modulus());
#pragma once

#include <string>
#include <vector>

#include <sinew/scene/prepare.h>

namespace sinew {

/// Stiffness of a part of the body along a direction.
struct StiffnessAlong {
  double young_modulus;  ///< modulus of the material along it, Pa
  double planes;         ///< half-planes of particles across the body there
  double lack;           ///< fraction of the bending stiffness that so few of them lack, at most
  double pulled_lack;    ///< the same of the stiffness against a pull

  /// Returns the modulus that a bending body shows, Pa.
  double bending_modulus() const { return young_modulus * (1 - lack); }
};

/// "70 kPa along it, less up to 23 % for 11 planes across": what a shown modulus is made of.
std::string parts_of_modulus(double along, double lack, double planes);

struct BoneStiffness : StiffnessAlong {
  std::string bone;
};

/// Finds the stiffness along each bone that holds particles.
std::vector<BoneStiffness> stiffness_along_bones(const Body& body);

/// The fraction of its stiffness against a pull (E A of the filled shape) that a body lacks because
/// it is only `planes` half-planes of particles across, at most: as lack_of_bending_stiffness(),
/// measured on the same bars.
double lack_of_pulled_stiffness(double planes, bool isotropic);

/// Stiffness from one support to another, or to a load.
struct SpanStiffness : StiffnessAlong {
  std::string from, to;
  bool bends;  ///< whether a motion or a force across bends it; else it is pulled

  double lack_shown() const { return bends ? lack : pulled_lack; }
  /// Returns the modulus that the body shows as it is strained, Pa.
  double shown_modulus() const { return young_modulus * (1 - lack_shown()); }
};

/// Finds the stiffness between each two supports that both hold along the line between them, and
/// between each support and each load with a resultant; without supports between loads. Those
/// nearer to each other than two layers are left out.
std::vector<SpanStiffness> stiffness_between_grips(const Prepared& prepared);

/// Adds a line where a body shows another modulus than that, by over 10 %, bent at some bone, or
/// strained between supports and loads.
void warn_of_stiffness(const Prepared& prepared, std::vector<std::string>& warnings);

}  // namespace sinew
