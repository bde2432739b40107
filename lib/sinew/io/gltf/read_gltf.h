// SPDX-License-Identifier: GPL-3.0-or-later
// Shapes out of glTF 2.0 files, .gltf and .glb, by VTK's loader behind a guard of our own.
#pragma once

#include <filesystem>

#include <sinew/core/triangles.h>

namespace sinew {

/// The triangles of the file's default scene (its first one where it names none, every node where
/// it has none), in meters, y up, as the file has them. Meshes stand where their nodes place them,
/// mirrored ones with their triangles turned so that outsides stay outside. A skinned mesh is taken
/// in its bind pose, put into the scene as bind_pose.h says: its node does not move it. Strips and
/// fans become triangles; points and lines are left out. Vertices no triangle uses are left out,
/// equal ones stay apart.
///
/// Throws bad input, with the path, for all that is not such a file, is damaged, holds no
/// triangles, has 2 GiB or more, or needs an extension that changes shapes (compression,
/// instancing); not written where the system's temporary folder takes no file.
PolygonSoup read_gltf(const std::filesystem::path& path);

}  // namespace sinew
