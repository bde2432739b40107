// SPDX-License-Identifier: GPL-3.0-or-later
// Vectors as arrows on VTK's stage.
#pragma once

#include "render/shot.h"

class vtkRenderer;

namespace sinew {

/// Each arrow from its place as far as it reaches, in the colour of its value.
void add_arrows(vtkRenderer& renderer, const Shot& shot, const ColourScale& scale);

}  // namespace sinew
