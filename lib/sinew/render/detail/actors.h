// SPDX-License-Identifier: GPL-3.0-or-later
// The objects in a picture as VTK actors: particles, skin, edges, the cut, bones, obstacles,
// arrows, lines, curves, traces and forces.
//
//     add_particles(stage.renderer(), snapshot, scale);
#pragma once

#include <sinew/core/color.h>
#include <sinew/render/shading.h>
#include <sinew/render/snapshot.h>

class vtkRenderer;

namespace sinew {

/// Spheres of the snapshot's radius in the colors of their values, held ones with a dot, as far as
/// they may be seen by the camera of `view`.
void add_particles(vtkRenderer& renderer, const Snapshot& snapshot, const ColorScale& scale,
                   const Mat3& view);

/// A dark dot on each held particle, toward the viewer.
void add_held_dots(vtkRenderer& renderer, const Snapshot& snapshot, const Mat3& view);

/// The part that its sides let be drawn, in the colors of its values; its edges likewise.
void add_skin(vtkRenderer& renderer, const Snapshot& snapshot, const Shading& skin,
              const ColorScale& scale);

struct LineStyle {
  double width = 1;  ///< width of the sharp edges, in rendered pixels; the others are thinner
  double lift = 0;   ///< off the skin, m
  double pixel = 0;  ///< size of one, m: lines that are a few pixels long at rest are left out
};

/// The skin's sharp edges.
void add_creases(vtkRenderer& renderer, const Snapshot& snapshot, const Shading& skin,
                 const LineStyle& style);

/// Its other edges, fainter.
void add_net(vtkRenderer& renderer, const Snapshot& snapshot, const Shading& skin,
             const LineStyle& style);

/// The cut face in the colors of its values, without light, and its outline on the skin.
void add_cut(vtkRenderer& renderer, const Snapshot& snapshot, const ColorScale& scale,
             const LineStyle& outline);

/// Tubes with joints, about `thickness` (m) thick.
void add_bare_bones(vtkRenderer& renderer, const Snapshot& snapshot, double thickness,
                    const Color& color);

/// The same, with their axes in red, green and blue.
void add_bones(vtkRenderer& renderer, const Snapshot& snapshot, double thickness,
               const Color& color);

/// Balls of `radius` (m) at the reference points of particles on their bones.
void add_references(vtkRenderer& renderer, const Snapshot& snapshot, double radius);

/// The obstacles within their space, with their outlines `line` rendered pixels wide.
void add_obstacles(vtkRenderer& renderer, const Snapshot& snapshot, double line);

/// The snapshot's lines in the colors of their values, `width` rendered pixels wide.
void add_lines(vtkRenderer& renderer, const Snapshot& snapshot, const ColorScale& scale,
               double width);

/// The curves as tubes about `thickness` (m) thick, in the colors of their values.
void add_curves(vtkRenderer& renderer, const Snapshot& snapshot, const ColorScale& scale,
                double thickness);

/// The traces as tubes about `thickness` (m) thick, each with its particle at the end.
void add_traces(vtkRenderer& renderer, const Snapshot& snapshot, double thickness);

/// Each arrow in its length, in the color of its value.
void add_arrows(vtkRenderer& renderer, const Snapshot& snapshot, const ColorScale& scale);

/// The forces of supports and loads as arrows that are readable on the paper.
void add_forces(vtkRenderer& renderer, const Snapshot& snapshot, const Paper& paper);

}  // namespace sinew
