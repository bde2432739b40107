// SPDX-License-Identifier: GPL-3.0-or-later
// What writer and reader of our VTU files have to agree on.
#pragma once

#include <string>

#include <sinew/core/dataset.h>
#include <sinew/core/options.h>

namespace sinew {

/// All up to the field data.
std::string vtu_opening(Encoding encoding);

/// VTK's number for cells of this kind.
int vtk_type(CellKind kind);

}  // namespace sinew
