// SPDX-License-Identifier: GPL-3.0-or-later
// The rig of a scene: skeleton and motion, from the scene's own lists or from files of any format.
//
//     const SceneRig rig = rig_of(settings);
#pragma once

#include <filesystem>

#include <sinew/rig/motion.h>
#include <sinew/settings/settings.h>

namespace sinew {

/// File names of rigs and clips that are not YAML, as help texts list them.
inline constexpr const char* rig_formats = "BVH, glTF, GLB";

/// Whether a file that is not YAML has a rig, and whether it may have a mesh: glTF may have both.
bool holds_rig(const std::filesystem::path& path);
bool holds_mesh(const std::filesystem::path& path);

/// The rig of such a file, in its own directions and units. Throws bad input, with the path.
Rig read_rig(const std::filesystem::path& path, const MotionOptions& motion);

/// From the bones and tracks in the scene itself. Throws bad input, with the scene's line.
Skeleton skeleton_of(const Settings& settings);
Motion motion_of(const Settings& settings, const Skeleton& skeleton);

struct SceneRig {
  Skeleton skeleton;
  Motion motion;
};

/// The clip of a file moves the bones of the same names. Throws bad input, with the scene's line.
SceneRig rig_of(const Settings& settings);

}  // namespace sinew
