// SPDX-License-Identifier: GPL-3.0-or-later
// The rig of a scene: skeleton and motion, from the scene's own lists or from files of any format.
//
//     const SceneRig rig = rig_of(settings, read_rig_files(settings));
#pragma once

#include <string>

#include <sinew/rig/motion.h>
#include <sinew/scene/scene_files.h>
#include <sinew/settings/settings.h>

namespace sinew {

/// Converts the bones and tracks in the scene itself. Throws bad input, with the scene's line.
Skeleton skeleton_of(const Settings& settings);
Motion motion_of(const Settings& settings, const Skeleton& skeleton);

/// The rig of a file, at rest as skeleton.rest_at says. Throws bad input, with the scene's line.
Rig at_rest(const Settings& settings, const Rig& rig);

/// The bone of that name, which the value at `key` gives. Throws bad input, with the scene's line.
int bone_of(const Settings& settings, const std::string& key, const Skeleton& skeleton,
            const std::string& name);
/// The bone that `entry`.bone names, no_bone for an empty name. Throws bad input, with the scene's
/// line.
int bone_at(const Settings& settings, const std::string& entry, const Skeleton& skeleton,
            const std::string& name);

struct SceneRig {
  Skeleton skeleton;
  Motion motion;
};

/// With the numbers that skeleton.fit finds in place of it. Reads the mesh and the rig for that;
/// errors name the scene's line.
Settings with_fit(Settings settings);

/// What it found: "skeleton.fit: scale 0.01, rotation [90, 0, 0], offset [0, 0, 1]", with units.
std::string fit_text(const SkeletonOptions& fitted);

/// The clip of a file moves the bones of the same names. Throws bad input, with the scene's line.
SceneRig rig_of(const Settings& settings, const SceneFiles& files);

}  // namespace sinew
