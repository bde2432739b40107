// SPDX-License-Identifier: GPL-3.0-or-later
// The things a picture shows, put onto VTK's stage.
#pragma once

#include <sinew/render/color.h>
#include <sinew/render/shading.h>
#include <sinew/render/snapshot.h>

class vtkRenderer;

namespace sinew {

/// Spheres of the snapshot's radius in the colors of their values.
void add_particles(vtkRenderer& renderer, const Snapshot& snapshot, const ColorScale& scale);

void add_skin(vtkRenderer& renderer, const Snapshot& snapshot, const Shading& skin);

struct LineStyle {
  double width = 1;  ///< of the sharp edges, in the drawn pixels; the others are thinner
  double lift = 0;   ///< off the skin, m
  double pixel = 0;  ///< size of one, m: a net of lines closer than a few of them is left out
};

/// The skin's sharp edges.
void add_creases(vtkRenderer& renderer, const Snapshot& snapshot, const Shading& skin,
                 const LineStyle& style);

/// Its other edges, fainter.
void add_net(vtkRenderer& renderer, const Snapshot& snapshot, const Shading& skin,
             const LineStyle& style);

/// Tubes with joints and their axes in red, green and blue, about `thickness` (m) thick.
void add_bones(vtkRenderer& renderer, const Snapshot& snapshot, double thickness,
               const Color& color);

}  // namespace sinew

// Vectors as arrows on VTK's stage.

class vtkRenderer;

namespace sinew {

/// Each arrow from its place as far as it reaches, in the color of its value.
void add_arrows(vtkRenderer& renderer, const Snapshot& snapshot, const ColorScale& scale);

}  // namespace sinew
