// SPDX-License-Identifier: GPL-3.0-or-later
// What is in a mesh, and what is wrong with it.
#pragma once

#include <string>

#include "command/results.h"
#include <sinew/settings/settings.h>

namespace sinew {

/// Adds the diagnosis of a body's mesh to `results`, and returns what deserves a look. Where
/// `drawing` is not empty the defects are written there, for ParaView.
std::vector<std::string> add_mesh_info(const BodyOptions& body, const std::string& drawing,
                                       Results& results);

}  // namespace sinew
