// SPDX-License-Identifier: GPL-3.0-or-later
// How a body rings as it is held: its lowest elastic modes, and how eq. 2 and its bones damp them,
// from the forces of its particles, bones, pins and supports about rest; of bodies over 8,000
// particles and thicker than 18 layers, those of a coarser packing of the same shape. What bones,
// pins and supports leave free to move as a whole rings about that.
//
//     const ElasticModes modes = elastic_modes(body);
//     body.material.damping = modes.damping_for(0.1);
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include <sinew/body/body.h>

namespace sinew {

struct ElasticModes {
  Eigen::VectorXd squared;         ///< w^2, ascending, 1/s^2; empty: the body has no elastic mode
  Eigen::MatrixXd rates;           ///< rates of eq. 2 between them for C = 1 kg/s, 1/s
  Eigen::MatrixXd rates_of_bones;  ///< rates of the damping of bones, 1/s
  /// Displacements by particle id of as many of the lowest modes as were asked for, or as there
  /// are; the largest of each is of length 1.
  std::vector<Points> shapes = {};

  bool empty() const { return squared.size() == 0; }
  /// Returns the frequency of the lowest mode, undamped, rad/s.
  double frequency() const;
  /// The damping ratio that the lowest mode has for a constant C of eq. 2 (kg/s), with the damping
  /// of bones and `rate` (1/s) more of it everywhere: of the eigenvalue that begins undamped and
  /// follows all of them, among all these modes.
  double damping_ratio(double damping, double rate = 0) const;
  /// The C (kg/s) that gives it; 0 where bones alone damp as much.
  double damping_for(double ratio) const;
  /// The rate (1/s) that gives it with that C; 0 where no more is needed.
  double rate_for(double ratio, double damping) const;

 private:
  /// The ratio for a matrix of rates between the modes, 1/s.
  double ratio_of(const Eigen::MatrixXd& damping) const;
};

/// Finds the modes of the body's largest connected part, so many of them to four digits and with
/// their shapes; none of a body of more than 200,000 particles that is too thin to be coarsened to
/// so many.
ElasticModes elastic_modes(const Body& body, int shapes = 0);

/// "bones and supports": what holds a body; "nothing".
std::string held_by(const Body& body);

/// Number of layers of particles across the thinnest tenth of a body in closest packing: from its
/// surface to the deepest particle below, and out again; infinite for other packings.
double layers_across(const Body& body);

/// The same body of fewer particles, `times` as large, in FCC packing along its axes, without
/// bones and world: each site stands for the particles that are nearest to it. Its material has the
/// same moduli and density; each particle has the same mass.
Body coarse_body(const Body& body, int times);

}  // namespace sinew
