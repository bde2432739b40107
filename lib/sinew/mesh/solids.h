// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies without a mesh: boxes and solids of revolution.
//
//     const Triangles bar = solid(SolidShape::capsule, {0.1, 0.1, 0.5});
//     append(capsule_between(bone.head(), bone.tail(), 0.02), body);
#pragma once

#include <array>
#include <string_view>

#include <sinew/core/triangles.h>

namespace sinew {

enum class SolidShape {
  box,       ///< with its sides along x, y and z
  sphere,    ///< an ellipsoid, where its sizes differ
  cylinder,  ///< along z
  capsule,   ///< along z: a cylinder with the halves of a ball as ends
};

/// In the order of SolidShape.
inline constexpr std::array<std::string_view, 4> solid_names = {"box", "sphere", "cylinder",
                                                                "capsule"};

/// Closed, outward, standing on z = 0 with its middle at x = y = 0. `size`: its sides along x, y, z
/// (m, each > 0); the others than a box are along z, elliptic where x and y differ. The ends of a
/// capsule are as high as half the lesser of x and y, at most half of z.
Triangles solid(SolidShape shape, const Vec3& size);

/// The points within `radius` (m, > 0) of the line between two places (m, apart): as a capsule of
/// 24 sides, whose points are on that body's surface, so that it is smaller by less than a
/// hundredth.
Triangles capsule_between(const Vec3& from, const Vec3& to, double radius);

/// Adds the points of `other`, after those that are there, and its faces on them. Parts that
/// overlap stay as they are: wrap() makes one skin of them.
void append(const Triangles& other, Triangles& all);

}  // namespace sinew
