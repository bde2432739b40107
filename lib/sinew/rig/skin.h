// SPDX-License-Identifier: GPL-3.0-or-later
// The surface follows the particles: each vertex X moves with the affine motions of the particles
// near it, x = sum_j w_j (x_j + F_j (X - X_j)), with w_j = (1 - (s / h)^2)^3 normalized, s = |X -
// X_j|. Exact for affine motion of the body.
//
//     const Skin skin = make_skin(vertices, rest, radius);
//     const Points moved = follow(skin, now);
//     const Column strain = at_vertices(skin, strain_of_particles);
#pragma once

#include <cstdint>
#include <vector>

#include <sinew/core/dataset.h>
#include <sinew/core/deformation.h>
#include <sinew/core/vector.h>
#include <sinew/rig/binding.h>

namespace sinew {

struct Skin {
  Points rest;                          ///< vertices at rest, n x 3, m
  std::vector<std::uint32_t> first;     ///< n + 1 long; vertex i has [first[i], first[i + 1])
  std::vector<std::uint32_t> particle;  ///< places in `weighted`
  std::vector<double> weight;           ///< sums to 1 for each vertex

  /// The particles that matter, ascending indices into the body's rest points: those with weights
  /// for vertices, their neighbors, and the neighbors of those, which give their deformation.
  std::vector<std::uint32_t> near;
  std::vector<std::uint32_t> weighted;  ///< particles with weights: ascending places in `near`
  RestShape shape;  ///< shape of `near`; complete for those with weights and their neighbors
};

/// Binds vertices (n x 3, m) to the particles at `points` (m, at rest, of radius `radius`, m)
/// closer than h = max(6 radius, 1.05 times the distance of the 20th particle). In parallel.
Skin make_skin(const Points& vertices, const Points& points, double radius);

/// The same, but a vertex follows particles of an unrelated bone (neither that of its nearest
/// particle nor its parent or child) only where a chain of touching particles within h connects
/// them: fingers do not follow each other.
Skin make_skin(const Points& vertices, const Points& points, double radius,
               const Skeleton& skeleton, const Binding& binding);

/// The same without particles that have too few neighbors to define a deformation, at corners and
/// in loose packings, where a vertex has others: it then follows every affine motion of the body.
Skin without_lone_particles(Skin skin);

/// The vertices when the particles are at `now` (m, in the order of the body's points). Parallel.
Points follow(const Skin& skin, const Points& now);

/// An array of the body's particles at the vertices: the mean by the weights of the particles that
/// have a value (not-a-number where none has). Whole numbers are those of the particle with the
/// largest weight. In parallel.
Column at_vertices(const Skin& skin, const Column& of_particles);

}  // namespace sinew
