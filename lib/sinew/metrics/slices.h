// SPDX-License-Identifier: GPL-3.0-or-later
// Slices across the bones, one lattice half-plane thick at rest, and the rotation of each. Bones
// that continue each other in one line at rest form a chain and are sliced as one, so that the
// twist from slice to slice is measured across their joints too.
//
//     const double angle = tip_turn(make_slices(rest, bone, bones, radius), rest, now);
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <sinew/core/vector.h>
#include <sinew/metrics/frame.h>
#include <sinew/rig/skeleton.h>

namespace sinew {

struct Slice {
  std::vector<std::uint32_t> particles;
  Vec3 axis = Vec3::Zero();  ///< axis of the bones it lies across, at rest
};

struct Slices {
  std::vector<Slice> all;  ///< slices whose turn is defined: four particles or more, not in line
  std::vector<std::array<int, 2>> neighbors;  ///< pairs in `all` that follow each other
  Slice tip;  ///< the last two half-planes of the last bone; empty where their turn is not defined
};

/// Cuts the particles (at rest, m) that follow bones (bone: index or -1 each) into slices of
/// thickness sqrt(2) r, the first one centered on the outermost particle of its chain.
Slices make_slices(const Points& rest, std::span<const int> bone, std::span<const Bone> bones,
                   double radius);

/// The rotation that best maps the particles' rest positions to their present ones, in the sense of
/// least squares about their centers (Kabsch).
Mat3 turn_of(const Slice& slice, const Points& rest, const Points& now);

/// Rotation angle of the tip, 0 to pi rad; not measured without a tip.
double tip_turn(const Slices& slices, const Points& rest, const Points& now);

/// The largest twist between consecutive slices, rad: the part of their relative rotation about
/// their present common axis (swing-twist decomposition). Not measured without a pair.
double largest_twist_jump(const Slices& slices, const Points& rest, const Points& now);

}  // namespace sinew
