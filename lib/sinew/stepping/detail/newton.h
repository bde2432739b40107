// SPDX-License-Identifier: GPL-3.0-or-later
// Newton's method for the equilibria of slender bodies, whose factor is small, and which relax
// slowly: the number of iterations of a relaxation grows with the square of their length.
//
//     Newton newton(body, near, id, gravity);
//     newton.predict(stepper, begin, soon, 1e-6);       // on the way of a load
//     while (!at_rest(stepper)) newton.correct(stepper, now);
#pragma once

#include <Eigen/SparseCholesky>
#include <cstddef>
#include <memory>
#include <optional>

#include <sinew/core/particles.h>
#include <sinew/stepping/detail/tangent.h>

namespace sinew {

class Newton {
 public:
  /// Particles `id` in the caller's order; `gravity` in m/s^2.
  Newton(const Body& body, const RestNeighbors& near, const Particles& particles,
         const Vec3& gravity);

  /// Nonzeros of the factor below its diagonal, by symbolic analysis.
  double nonzeros() const { return factor_.nonzeros(); }
  /// Products of a factorization.
  double products() const { return factor_.products(); }

  /// What a solution came to.
  struct Solution {
    Points positions;           ///< positions that it leads to, m
    std::int64_t negative = 0;  ///< pivots: the body would buckle there
  };
  /// Where the body comes to, by its tangent at `begin`, where it is at rest, when all that acts on
  /// it changes as it does from `begin` to `soon`, 1/`part` times as long. None: singular tangent.
  std::optional<Solution> predict(Stepper& stepper, const TimedPose& begin, const TimedPose& soon,
                                  double part);
  /// Where it comes to by the forces that nothing answers at the moment.
  std::optional<Solution> correct(Stepper& stepper, const TimedPose& now);
  /// How many directions there are in which the body, as it is, would leave an equilibrium.
  std::int64_t negative_pivots(Stepper& stepper, const TimedPose& now);
  /// Where the particles were before these, in the order of the stepper.
  const Points& positions() const { return positions_; }

 private:
  struct Factor : Eigen::SimplicialLDLT<Tangent::Matrix> {
    double nonzeros() const { return static_cast<double>(m_matrix.nonZeros()); }
    double products() const { return m_nonZerosPerCol.cast<double>().squaredNorm(); }
  };

  const Points& read(Stepper& stepper, const TimedPose& now);
  /// How far a step may turn or strain any pair, and whether energy must fall along it: so that
  /// corrections end in stable equilibria alone, but where they begin in others.
  struct Step {
    double max_gradient;
    bool downhill;
  };
  Tangent::Vector step_down(const Tangent::Vector& forces) const;
  std::optional<Solution> solve(const Tangent::Matrix& matrix, const Tangent::Vector& forces,
                                Step step);

  Tangent tangent_;
  Factor factor_;
  Particles particles_;
  Points positions_;
  Vec3 gravity_;
};

}  // namespace sinew
