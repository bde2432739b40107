// SPDX-License-Identifier: GPL-3.0-or-later
// Boxes of the paper's proportions in six states, bound to two bones end to end: what stepping is
// timed on. A state is an analytic map of the rest positions that follows the bones, left to relax.
#pragma once

#include <array>
#include <string_view>

#include <sinew/rig/motion.h>
#include <sinew/stepping/simulation.h>

namespace sinew::bench {

enum class Condition {
  rest,
  bent,     ///< by 90 degrees, an even curve of three widths, kept there by strong bones
  twisted,  ///< by 90 degrees, evenly over the whole length, by its bones
  crushed,  ///< to 0.75 of its width along x, and kept there by strong bones
  flowed,   ///< wholly disordered
  bending,  ///< at 45 degrees, by 90 degrees per second
};

inline constexpr std::array conditions{Condition::rest,    Condition::bent,   Condition::twisted,
                                       Condition::crushed, Condition::flowed, Condition::bending};

/// What a body is made of, how it is damped, and what surrounds it: one thing is not as in the
/// paper.
enum class Variant {
  paper,
  initial_neighbors,
  bonded,        ///< isotropic: eighteen bonds
  twelve_bonds,  ///< bonded, to nearest neighbors alone
  bonded_volume,
  breaking,
  yielding,
  symmetric,
  central,
  plane,     ///< that it stands on
  sphere,    ///< pressed into its side
  pinned,    ///< at its lower end
  muscle,    ///< in all of it
  relaxing,  ///< bonded, with two branches
  pressed,   ///< bonded, on its whole surface
  grouped,   ///< far from joints that move
};

inline constexpr std::array variants{Variant::paper,         Variant::initial_neighbors,
                                     Variant::bonded,        Variant::twelve_bonds,
                                     Variant::bonded_volume, Variant::breaking,
                                     Variant::yielding,      Variant::symmetric,
                                     Variant::central,       Variant::plane,
                                     Variant::sphere,        Variant::pinned,
                                     Variant::muscle,        Variant::relaxing,
                                     Variant::pressed,       Variant::grouped};

std::string_view name_of(Condition condition);
std::string_view name_of(Variant variant);
/// Throws bad input for another name.
Condition condition_named(std::string_view name);

/// A body, its constant pose, and the map's positions, from which it relaxes.
struct Scene {
  Body body;
  Motion motion;
  Motion approach;  ///< of the bones until the state is reached; none: they stay
  int approach_steps = 0;
  Particles start;  ///< without velocity
  double step = 0;  ///< half of the stability limit, s
};

/// About `count` particles of the default material, r = 10 mm.
Scene scene_of(Condition condition, std::size_t count, Variant variant = Variant::paper);

/// The state after 100 steps (flowed: 400, rest: none; bending: half a second) from the scene's
/// start, in the written order.
Particles settled(const Scene& scene, Condition condition);

/// A simulation of the scene's body that starts with `particles`.
Simulation simulation_of(const Scene& scene, const Particles& particles, Precision precision,
                         NeighborSearch search);

}  // namespace sinew::bench
