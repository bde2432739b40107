// SPDX-License-Identifier: GPL-3.0-or-later
// The moments that represent a motion in a few pictures, and what each of them shows.
//
//     for (const KeyMoment& moment : key_moments(overview, radius)) draw(moment.frame);
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <sinew/run/run_files.h>

namespace sinew {

struct RunOverview;

/// The bone that has turned most since rest.
struct Turned {
  double angle = 0;  ///< rad
  std::size_t bone = 0;
};

Turned largest_turn(const RunFiles& run, const FrameState& frame);

struct KeyMoment {
  std::size_t frame = 0;
  std::string what;  ///< words such as "largest bend"; empty: nothing to say
};

/// Rest, half the largest turn of a bone, the largest (the last such frame), and the end; evenly
/// over all frames where no bone turns. A run that begins posed, with half the largest turn, has
/// the frame that is farthest from its first one in place of both. `radius` of a particle, m.
std::vector<KeyMoment> key_moments(const RunOverview& overview, double radius);

/// Whether and how exactly a body has come back in the end, in the mean and where it is worst; "":
/// its bones have not.
std::string return_in_words(const RunOverview& overview, double radius);

}  // namespace sinew
