// SPDX-License-Identifier: GPL-3.0-or-later
// Slices across the bones, one lattice half-plane thick at rest, and how each of them has turned.
// Bones that continue each other in one line at rest form a chain and are sliced as one, so that
// the turn from slice to slice shows across their joints too.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <sinew/core/vector.h>
#include <sinew/metrics/frame.h>

namespace sinew {

struct Slice {
  std::vector<std::uint32_t> particles;
  Vec3 axis = Vec3::Zero();  ///< of the bones it lies across, at rest
};

struct Slices {
  std::vector<Slice> all;  ///< those whose turn is defined: four particles or more, not in one line
  std::vector<std::array<int, 2>> neighbors;  ///< pairs in `all` that follow each other
  Slice tip;  ///< the last two half-planes of the last bone; empty where their turn is not defined
};

/// Cuts the particles (at rest, m) that follow bones (bone: index or -1 each) into slices of
/// thickness sqrt(2) r, the first one centered on the outermost particle of its chain.
Slices make_slices(const Points& rest, std::span<const int> bone,
                   std::span<const MeasuredBone> bones, double radius);

/// The rotation that carries the particles' rest positions to their present ones best, in the sense
/// of least squares about their centers (Kabsch).
Mat3 turn_of(const Slice& slice, const Points& rest, const Points& now);

/// Angle of the tip's turn, 0 to pi rad; not measured without a tip.
double tip_turn(const Slices& slices, const Points& rest, const Points& now);

/// The largest twist between slices that follow each other, rad: the part of their relative turn
/// that is about their common axis now (the twist of swing and twist). Not measured without a pair.
double largest_twist_jump(const Slices& slices, const Points& rest, const Points& now);

}  // namespace sinew
