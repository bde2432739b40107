// SPDX-License-Identifier: GPL-3.0-or-later
// Which files are read as glTF: those that are, and files of other programs, FBX and COLLADA, as
// the GLB that Blender makes of them.
//
//     const SkinnedRig body = read_gltf_rig("body.fbx");
//     const std::filesystem::path glb = gltf_of("body.fbx");  // body.fbx.0123456789abcdef.glb
//
// Blender reads binary FBX of version 7.1 and later, and COLLADA up to its own version 4.5; what it
// does not read is refused with its words. Each take becomes a clip, sampled at the file's
// frame rate; COLLADA has seconds instead, and is sampled at the lowest usual rate that has all its
// keys. Materials come without their images. Lengths become meters and y up, as the file says.
//
// The script that Blender runs is detail/blender_script.h; it uses neither the network nor the
// user's preferences.
#pragma once

#include <filesystem>
#include <string>

namespace sinew {

/// Whether a path has the extension of glTF, .gltf, .glb or .vrm, or needs Blender.
bool is_gltf(const std::filesystem::path& path);

/// Whether Blender has to convert the file, by its extension: .fbx or .dae.
bool needs_blender(const std::filesystem::path& path);

struct BlenderOptions {
  std::string program = "blender";  ///< found by PATH
  double patience = 300;            ///< s, after which a converter is taken to hang
};

/// The path itself, or of a file that needs Blender, the GLB that Blender makes of it: beside it as
/// NAME.HASH.glb, by its content, so that it is made once; where that cannot be written, HASH.glb
/// in the folder `sinew` of the user's cache ($XDG_CACHE_HOME or ~/.cache). Throws bad input, with
/// the path, where Blender is missing, hangs, crashes or cannot read the file.
std::filesystem::path gltf_of(const std::filesystem::path& path,
                              const BlenderOptions& options = {});

}  // namespace sinew
