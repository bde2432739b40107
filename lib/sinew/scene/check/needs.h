// SPDX-License-Identifier: GPL-3.0-or-later
// The resources that a run will need.
//
//     const Needs needs = needs_of(prepared);
//     check_space(folder, needs, 0);
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <sinew/scene/prepare.h>
#include <sinew/scene/steps.h>
#include <sinew/settings/settings.h>

namespace sinew {

struct Needs {
  std::uint64_t disk = 0;    ///< bytes of all frames and checkpoints
  std::uint64_t memory = 0;  ///< bytes while stepping
};

Needs needs_of(const Prepared& prepared);

/// Particle-steps per second of the body at rest, measured within half a second; a typical value
/// where the body becomes unstable, of which a line is added.
double speed_at_rest(Prepared prepared, std::vector<std::string>& warnings);
/// The same of a body that its bones deform.
double speed_in_motion(const Prepared& prepared, double at_rest);

/// Seconds that `sinew run` takes after its steps: for pictures, report and movie, on two cores.
/// `points`: particles, and triangles of the surface.
double seconds_of_showing(std::size_t points, int frames);

/// Bytes a user may still write where `folder` is or will be.
std::uint64_t free_space(const std::filesystem::path& folder);

/// Throws not written when the disk has less space than the run needs; `freed` bytes will be freed
/// before it begins.
void check_space(const std::filesystem::path& folder, const Needs& needs, std::uint64_t freed);

}  // namespace sinew
