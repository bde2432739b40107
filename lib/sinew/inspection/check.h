// SPDX-License-Identifier: GPL-3.0-or-later
// What a scene needs, how its body behaves, and which of its settings are doubtful, before it runs.
//
//     const SceneCheck check = check_scene(prepare({read_scene("scene.yaml")}), "out/scene");
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <sinew/inspection/findings.h>
#include <sinew/scene/intrusions.h>
#include <sinew/scene/prepare.h>

namespace sinew {

struct SceneCheck {
  Findings findings;
  std::vector<std::string> warnings;  ///< each with its cure
  std::vector<Intrusion> meeting;     ///< flesh that the motion drives into other flesh
  std::vector<Points> shapes;         ///< shapes of the modes that were found, by particle id
};

/// Steps the body for up to a second or so to measure speed. `folder`: where the run will be;
/// `modes`: how many of the lowest elastic modes to list.
SceneCheck check_scene(const Prepared& prepared, const std::filesystem::path& folder,
                       int modes = 1);

/// Writes a series of 12 frames, a period of each mode: arrays mode_1, mode_2 and so on (m) on the
/// points of body.vtu, the largest displacement a tenth of the body's extent. Times are fractions
/// of the period. `path` ends in .pvd. Throws not written.
void write_modes(const Prepared& prepared, const std::vector<Points>& shapes,
                 const std::filesystem::path& path);

}  // namespace sinew
