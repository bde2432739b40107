// SPDX-License-Identifier: GPL-3.0-or-later
// What holds a body's particles at rest, linear in their displacements: the springs and the damping
// of bones, and what pins and supports prescribe.
//
//     const Holding holding = holding_of(body);
//     const Holding coarse = spread_onto(coarse.rest, spacing, body.rest, holding);
#pragma once

#include <cstddef>
#include <vector>

#include <sinew/body/body.h>

namespace sinew {

/// Values by particle; all empty where nothing holds any.
struct Holding {
  std::vector<Mat3> springs;  ///< N/m
  std::vector<Mat3> damping;  ///< kg/s
  std::vector<Mat3> free;     ///< projector on directions that pins and supports leave free

  bool empty() const { return springs.empty(); }
  /// Holds the particles at those places alone.
  Holding part(const std::vector<std::size_t>& places) const;
};

Holding holding_of(const Body& body);

/// The same for particles at `coarse`, that far apart (m): each takes what those nearest to it have
/// together, and is held where any of them is.
Holding spread_onto(const Points& coarse, double spacing, const Points& rest,
                    const Holding& holding);

}  // namespace sinew
