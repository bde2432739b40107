// SPDX-License-Identifier: GPL-3.0-or-later
// The motion of a body depends on its shape and material: not on the time step, hardly on the
// particles' size, and not on the unit of length.
#include <gtest/gtest.h>

#include <sinew/rig/skin.h>

#include "support/world.h"

namespace sinew::invariance_test {

/// A bonded bar of 0.14 x 0.14 x 0.5 m, filled with particles of radius r and bent by 60 degrees;
/// `scale` makes all lengths and times longer.
struct Bent {
  double r = 0.0125, time_step_factor = 0.5, scale = 1;
  MaterialModel model = MaterialModel::bonded;

  Simulation at_the_end() const {
    const double plane = half_plane_spacing(r);
    const int across = static_cast<int>(std::lround(0.14 / plane)),
              along = static_cast<int>(std::lround(0.5 / plane));
    Points rest = test::fcc_box(across, across, along, r * scale);
    Settings settings = test::box_scene(along);
    settings.body.radius = r * scale;
    settings.material.model = model;
    settings.bones = {{"lower", "", Vec3(0, 0, 0), Vec3(0, 0, 0.25 * scale)},
                      {"upper", "lower", {}, Vec3(0, 0, 0.5 * scale)}};
    settings.tracks = {
        test::track("upper", {test::bend_key(0, 0), test::bend_key(0.5 * scale, 60)})};
    settings.solver.time_step_factor = time_step_factor;
    settings.output.interval = scale / 32;
    settings.solver.duration = scale;
    Simulation simulation = test::make_simulation(settings, rest);
    while (simulation.time() < 0.75 * scale) simulation.step();
    return simulation;
  }
};

/// Points on the bar's sides, moved with the particles about them.
Points sides_of(const Simulation& simulation) {
  Points sides;
  for (double z = 0.02; z < 0.5; z += 0.04)
    for (const double x : {-0.06, 0.0, 0.06})
      for (const double y : {-0.06, 0.0, 0.06}) sides.push_back({x, y, z});
  const Body& body = simulation.body();
  return follow(make_skin(sides, body.rest, body.material.pair.r, body.skeleton, body.binding),
                positions_of(simulation.particles()));
}

/// Root mean square of the distances, m.
double apart(const Points& a, const Points& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(a.size()));
}

TEST(Result, DoesNotDependOnTheTimeStep) {
  const Bent bent;
  Bent finer = bent;
  finer.time_step_factor = 0.2;
  EXPECT_LT(apart(sides_of(bent.at_the_end()), sides_of(finer.at_the_end())), 0.02 * bent.r);
}

TEST(Result, HardlyDependsOnTheSizeOfTheParticles) {
  const Points coarse = sides_of(Bent{0.0125}.at_the_end()),
               middle = sides_of(Bent{0.009}.at_the_end());
  EXPECT_LT(apart(coarse, middle), 0.02 * 0.5);  // of the bar's length
}

TEST(Result, IsTheSameInAnyUnitOfLength) {
  for (const auto model :
       {MaterialModel::paper, MaterialModel::bonded, MaterialModel::bonded_volume}) {
    Bent small, large;
    small.model = large.model = model;
    large.scale = 4;  // a power of two keeps every bit
    const Points a = positions_of(small.at_the_end().particles()),
                 b = positions_of(large.at_the_end().particles());
    for (std::size_t i = 0; i < a.size(); ++i) ASSERT_EQ(Vec3(4 * a[i]), b[i]) << i;
  }
}

}  // namespace sinew::invariance_test
