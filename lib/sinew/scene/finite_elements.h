// SPDX-License-Identifier: GPL-3.0-or-later
// A scene's body as finite elements for another program: its shape, materials, supports and loads,
// and the equilibria that the static method brings its particles to.
//
//     const Deck deck = deck_of(settings, read_mesh(settings).triangles, {});
//     write_deck("beam.inp", deck);
#pragma once

#include <optional>

#include <sinew/io/calculix/deck.h>
#include <sinew/mesh/surface.h>
#include <sinew/settings/settings.h>

namespace sinew {

struct ElementOptions {
  std::optional<double> size = {};  ///< size of elements, m; by default 4 radii of the particles
  bool linear = false;              ///< equilibrium in the shape at rest
  int frequencies = 0;              ///< so many lowest modes as it is held, instead of equilibria
};

/// Hexahedra for a box along the axes, tetrahedra for other shapes. There is a step for the time of
/// each frame, but for one at 0 at which nothing acts, and so many between as keep
/// supports from turning by more than 15 degrees in one. Forces are distributed over nodes as the
/// elements' shape functions ask. Of frequencies there is one step without loads. Throws bad input,
/// with the scene's line, for a scene that is not static (but of frequencies), for what elements
/// cannot hold (bones, obstacles, pins, fields, muscles, materials that are not elastic and
/// isotropic, several bodies), for parts as ElementParts does, and for supports that contradict
/// each other.
Deck deck_of(const Settings& settings, const Surface& surface, const ElementOptions& options);

}  // namespace sinew
