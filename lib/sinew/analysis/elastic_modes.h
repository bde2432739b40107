// SPDX-License-Identifier: GPL-3.0-or-later
// How a body rings by itself: its lowest elastic modes without bones and surroundings, and how eq.
// 2 damps them, from the forces of its own particles about rest; of bodies over 8,000 particles and
// thicker than 18 layers, those of a coarser packing of the same shape.
//
//     const ElasticModes modes = elastic_modes(body);
//     body.material.damping = modes.damping_for(0.1);
#pragma once

#include <Eigen/Core>

#include <sinew/body/body.h>

namespace sinew {

struct ElasticModes {
  Eigen::VectorXd squared;  ///< w^2, ascending, 1/s^2; empty: the body has no elastic mode
  Eigen::MatrixXd rates;    ///< of eq. 2 between them for C = 1 kg/s, 1/s

  bool empty() const { return squared.size() == 0; }
  /// Returns the frequency of the lowest mode, undamped, rad/s.
  double frequency() const;
  /// The damping ratio that the lowest mode has for a constant C of eq. 2 (kg/s): of the eigenvalue
  /// that begins there and follows C, among all these modes.
  double damping_ratio(double damping) const;
  /// The C (kg/s) that gives it.
  double damping_for(double ratio) const;
};

/// Finds the modes of the body's largest connected part; none of a body of more than 200,000
/// particles that is too thin to be coarsened to so many.
ElasticModes elastic_modes(const Body& body);

/// Number of layers of particles across the thinnest tenth of a body in closest packing: from its
/// surface to the deepest particle below, and out again; infinite for other packings, which have
/// none.
double layers_across(const Body& body);

/// The same body of fewer particles, `times` as large, in FCC packing along its axes, without
/// bones and world: each site stands for the particles that are nearest to it. Its material has the
/// same moduli and density; each particle has the same mass.
Body coarse_body(const Body& body, int times);

}  // namespace sinew
