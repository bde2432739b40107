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
};

/// Steps the body for up to a second or so to measure speed. `folder`: where the run will be.
SceneCheck check_scene(const Prepared& prepared, const std::filesystem::path& folder);

}  // namespace sinew
