// SPDX-License-Identifier: GPL-3.0-or-later
// A study of a scene to begin with: the settings that are varied most often, around those of the
// scene, with comments.
//
//     write_file("bend_study.yaml", new_study("bend.yaml", read_scene("bend.yaml")));
#pragma once

#include <string>

#include <sinew/settings/settings.h>

namespace sinew {

/// `scene`: as the study names it.
std::string new_study(const std::string& scene, const Settings& settings);

}  // namespace sinew
