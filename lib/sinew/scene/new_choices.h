// SPDX-License-Identifier: GPL-3.0-or-later
// What a new scene is made of, before it is text.
//
//     const std::string text = new_scene_text(choices, folder);
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <sinew/rig/limb_bones.h>
#include <sinew/settings/settings.h>

namespace sinew {

/// Time of the scene after the motion, s.
inline constexpr double rest_after = 0.2;

struct NewChoices {
  Settings settings;                    ///< paths relative to the current directory
  std::string unit, axes, bones, size;  ///< why; see NewScene
  std::size_t particles = 0;
  Box box;                              ///< of the body, m
  double thickness = 0;                 ///< of its limbs, m
  std::vector<std::string> clips = {};  ///< others than the one that plays
  std::string clip_note = {};           ///< about that one
  std::string refined_from = {};        ///< the file whose triangles were too large
};

/// The scene, as a file in `folder`.
std::string new_scene_text(const NewChoices& choices, const std::filesystem::path& folder);

}  // namespace sinew
