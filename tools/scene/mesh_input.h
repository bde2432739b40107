// SPDX-License-Identifier: GPL-3.0-or-later
// The mesh of a scene, or on the command line, ready to be filled: read by the room that knows its
// format, repaired where that was asked for, cleaned.
#pragma once

#include "core/settings.h"
#include "mesh/surface.h"

namespace sinew {

inline constexpr const char* mesh_formats = "OBJ, OFF, STL, PLY, glTF, GLB";

/// Reads body.mesh with the options of the section body. Throws Error (bad input) naming the file.
Surface read_body_mesh(const BodySettings& body);

}  // namespace sinew
