// SPDX-License-Identifier: GPL-3.0-or-later
// Simple solids and their exact signed distances: the shapes of obstacles and regions.
//
//     const SignedDistance at = signed_distance(SphereShape{center, radius}, point);
//
// Distances are to the nearest point of the surface, inside as well as outside, so they are
// continuous and the normal is their gradient. Where several points of the surface are equally near
// (the middle of a sphere, the axis of a capsule, the planes halfway between a box's faces) the
// normal is one of them, always the same.
#pragma once

#include <functional>
#include <string>
#include <variant>

#include <sinew/core/triangles.h>
#include <sinew/core/vector.h>

namespace sinew {

struct SignedDistance {
  double distance = 0;          ///< m, negative inside
  Vec3 normal = Vec3::UnitZ();  ///< outward, unit
};

/// The half-space behind a plane.
struct PlaneShape {
  Vec3 point = Vec3::Zero();    ///< m
  Vec3 normal = Vec3::UnitZ();  ///< outward, of any length but 0
};

struct SphereShape {
  Vec3 center = Vec3::Zero();  ///< m
  double radius = 1;           ///< m, > 0
};

/// A segment and all points nearer to it than the radius; a sphere where the ends coincide.
struct CapsuleShape {
  Vec3 a = Vec3::Zero(), b = Vec3::Zero();  ///< ends of the segment, m
  double radius = 1;                        ///< m, > 0
};

struct BoxShape {
  Vec3 center = Vec3::Zero();        ///< m
  Vec3 half = Vec3::Ones();          ///< half the edges, m, > 0
  Mat3 rotation = Mat3::Identity();  ///< columns are the box's axes
};

/// A closed surface, given by its distance function.
struct MeshShape {
  std::function<SignedDistance(const Vec3&)> distance;  ///< may be called from many threads
  Box bounds;  ///< box of the surface, m; the distance is not evaluated far outside it
};

using Shape = std::variant<PlaneShape, SphereShape, CapsuleShape, BoxShape, MeshShape>;

/// Measures `point` from `shape`, both in the shape's own coordinates.
SignedDistance signed_distance(const Shape& shape, const Vec3& point);

/// Whether the signed distance of `point` may be below `range` (m >= 0): a cheap test.
bool may_be_within(const Shape& shape, const Vec3& point, double range);

/// Whether that of any point of `box` (m, not empty) may be below `range` (m >= 0).
bool may_be_near(const Shape& shape, const Box& box, double range);

/// Throws bad input, naming `what` the shape is for, for sizes that are not positive and finite, a
/// plane without direction, a box whose axes are not square, a mesh without distance or bounds.
void check_shape(const Shape& shape, const std::string& what);

// The shapes of obstacles as triangles, for rendering.

/// Triangles of a shape in its own coordinates, counter-clockwise seen from outside. A plane is a
/// square of edge `size` (m) about its point; spheres and capsules are round to about 1 % of their
/// radius. A mesh gives none: its owner has them.
Triangles surface_of(const Shape& shape, double size);

}  // namespace sinew
