// SPDX-License-Identifier: GPL-3.0-or-later
// The things a picture shows, put onto VTK's stage.
#pragma once

#include "render/colour.h"
#include "render/shot.h"
#include "render/skin.h"

class vtkRenderer;

namespace sinew {

/// Spheres of the shot's radius in the colours of their values.
void add_particles(vtkRenderer& renderer, const Shot& shot, const ColourScale& scale);

void add_skin(vtkRenderer& renderer, const Shot& shot, const Skin& skin);

/// The skin's sharp edges as thin lines, lifted off it by `lift` (m).
void add_creases(vtkRenderer& renderer, const Shot& shot, const Skin& skin, double lift);

/// Its other edges, fainter; none of them when they lie closer than a few times `pixel` (m).
void add_net(vtkRenderer& renderer, const Shot& shot, const Skin& skin, double pixel, double lift);

/// Tubes with joints and their axes in red, green and blue, about `thickness` (m) thick.
void add_bones(vtkRenderer& renderer, const Shot& shot, double thickness, const Colour& colour);

}  // namespace sinew
