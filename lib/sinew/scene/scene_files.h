// SPDX-License-Identifier: GPL-3.0-or-later
// The files that a scene names beside its mesh, read before the work begins; what a path names, and
// outputs that would replace what a command reads.
//
//     const SceneFiles files = read_files(settings);
//     const Binding binding = bind_scene(settings, files, skeleton, rest, nearest, radius);
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

#include <sinew/mesh/surface.h>
#include <sinew/rig/motion.h>
#include <sinew/rig/skinning.h>
#include <sinew/settings/settings.h>

namespace sinew {

/// File names of rigs and clips that are not YAML, as help texts list them.
inline constexpr const char* rig_formats = "BVH, glTF, GLB, VRM, FBX, COLLADA";

/// Whether a file that is not YAML has a rig, and whether it may have a mesh: glTF may have both,
/// or one of them.
bool holds_rig(const std::filesystem::path& path);
bool holds_mesh(const std::filesystem::path& path);

/// Whether a path names a table of keys (rig/key_table.h).
bool is_key_table(const std::filesystem::path& path);

/// Whether a path names a scene (by .yaml or .yml) rather than a mesh.
bool is_scene(const std::filesystem::path& path);

/// Throws bad input for a mesh or a BVH file, by its extension, where a scene is expected.
void refuse_mesh_as_scene(const std::string& path);

/// Throws bad input for an output that is there and a scene.
void refuse_to_replace_scene(const std::filesystem::path& output);

/// Throws Error (bad input) for an output of another extension, that is one of the inputs, or a
/// scene.
void refuse_output(const std::string& output, std::initializer_list<std::string> inputs,
                   const std::string& extension = ".vtu");

/// The rig of such a file, in its own directions and units. Throws bad input, with the path.
SkinnedRig read_rig(const std::filesystem::path& path, const MotionOptions& motion);

/// Empty where the scene names none.
struct SceneFiles {
  SkinnedRig skeleton;                     ///< rig of skeleton.file
  Rig motion;                              ///< rig of motion.file
  std::vector<TrackDefinition> keys = {};  ///< keys of motion.file, where it is a table of them
  std::vector<Surface> obstacles;          ///< meshes of world.obstacles; empty for other shapes
  Triangles surface;                       ///< surface of the body; read_files() has none
};

/// Throws bad input, with the scene's line, for files that cannot be read.
SceneFiles read_files(const Settings& settings);
/// The same without the obstacles.
SceneFiles read_rig_files(const Settings& settings);

}  // namespace sinew
