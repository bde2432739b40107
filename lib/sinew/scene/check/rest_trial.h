// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a scene's body keeps its shape at rest, found by trial: without its world, its last bone
// turns by 3 degrees and back, and the body is left alone for 10 s. Bodies of over 4,000 particles
// are tried with 3,000, if the scene can be prepared with these.
//
//     const RestTrial trial = try_rest(prepared);
//     results.add("rest", text_of(trial));
#pragma once

#include <cstddef>
#include <string>

#include <sinew/scene/prepare.h>

namespace sinew {

/// stable: comes back; creeps: is off by over creeping_shift radii (root mean square) at the end;
/// unstable: by over collapsed_shift, or falls apart.
enum class RestState { stable, creeps, unstable };
inline constexpr double creeping_shift = 0.01, collapsed_shift = 0.5;  // radii

struct RestTrial {
  RestState state = RestState::stable;
  double shift = 0;           ///< root mean square, at `time`, radii
  double time = 0;            ///< s: the end, or the moment of collapse
  std::size_t particles = 0;  ///< number tried; 0: none, as nothing could let them go
};

/// Steps the body where second neighbors are within the reach of an attraction: bonds, and shorter
/// ranges, keep a packing. Takes a second or two, of stiff bodies some ten: they are tried for less
/// than 10 s then.
RestTrial try_rest(const Prepared& prepared);

/// "stable", "creeps" or "unstable".
const char* name_of(RestState state);
/// The same with the figures: "creeps, by 0.025 radii within 10 s".
std::string text_of(const RestTrial& trial);
/// What is wrong with an unstable body, and the cure; "": it is not.
std::string warning_of(const RestTrial& trial);

}  // namespace sinew
