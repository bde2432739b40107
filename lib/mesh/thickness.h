// SPDX-License-Identifier: GPL-3.0-or-later
// How thin a body is, by rays from its faces to the other side.
#pragma once

#include <optional>

#include "core/triangles.h"

namespace sinew {

/// The thickness (m) below which 1 % of the skin lies. From 2,000 places spread evenly over the
/// area (fewer where most faces are needles) a ray goes inward, across the face, until it has left
/// all parts of the body it came through; places within another part are no skin. Nothing where
/// fewer than half of the rays find an end: a sheet has no inside.
std::optional<double> thinnest_part(const Triangles& surface);

}  // namespace sinew
