// SPDX-License-Identifier: GPL-3.0-or-later
// A slender bonded beam bends as far as the elastica under the same end load.
#include <gtest/gtest.h>

#include "support/machine.h"

namespace sinew::elastica_test {

using namespace machine;

constexpr int planes = 5, lengths_of_height = 20;

/// A square beam, clamped at its lowest plane, under a load (N) along x at its end.
Machine slender_beam(double load) {
  Machine machine(MaterialModel::bonded, (planes - 1) * lengths_of_height + 1);
  machine.world.supports = {{"clamp", machine.bottom()}};
  machine.world.loads = {machine.pull(machine.top(), {load, 0, 0})};
  return machine;
}

/// Displacement of the end's center.
Vec3 end_under(double load) {
  const Machine machine = slender_beam(load);
  LoadSteps at_once;
  at_once.solver = StaticSolver::newton;
  at_once.residual = 1e-7, at_once.acceptable = 1e-4;
  const Simulation beam = machine.at_rest(at_once);
  Vec3 sum = Vec3::Zero();
  for (const std::uint32_t i : machine.top()) sum += beam.particles().position(i) - machine.rest[i];
  return sum / static_cast<double>(machine.top().size());
}

/// Displacement of the end of the elastica, over its length: sideways, and back along the beam
/// (elliptic integrals; Mattiasson, Int. J. Numer. Methods Eng. 17, 1981, 145).
struct Elastica {
  double load;  // P L^2 / (E I)
  double sideways, back;
};

TEST(Elastica, IsTheShapeOfASlenderBondedBeam) {
  const Machine beam = slender_beam(0);
  const double L = beam.rest.back().z() - beam.rest.front().z(),
               little = 1e-5;  // N, of 7e-3 that bend it by a third of its length
  const double bending = little * L * L * L / (3 * end_under(little).x());  // E I
  for (const Elastica& known : {Elastica{1, 0.30172, 0.05643},
                                {2, 0.49346, 0.16064},
                                {3, 0.60325, 0.25442},
                                {4, 0.66996, 0.32894},
                                {5, 0.71379, 0.38763}}) {
    const Vec3 end = end_under(known.load * bending / (L * L));
    EXPECT_NEAR(end.x() / L, known.sideways, 0.01 * known.sideways) << known.load;
    EXPECT_NEAR(-end.z() / L, known.back, 0.01) << known.load;
  }
}

}  // namespace sinew::elastica_test
