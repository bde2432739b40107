// SPDX-License-Identifier: GPL-3.0-or-later
// Bars of particles in groups.
#pragma once

#include <sinew/body/grouping.h>
#include <sinew/groups/make_grouping.h>

#include "support/all_steppers.h"

namespace sinew::groups_test {

inline constexpr double r = 0.01;

inline constexpr MaterialModel models[] = {MaterialModel::paper, MaterialModel::bonded,
                                           MaterialModel::bonded_volume};

/// Groups by a function of the place at rest.
struct Bar {
  Settings settings;
  Points rest;
  Body body;
  Particles particles;
  double step = 0;

  template <class GroupOf>
  Bar(const Settings& given, Points places, const GroupOf& group_of)
      : settings(given),
        rest(std::move(places)),
        body(test::make_body(settings, rest)),
        particles(test::particles_of(settings, rest)),
        step(test::step_of(settings, body)) {
    std::vector<std::int32_t> group;
    for (const Vec3& X : rest) group.push_back(group_of(X));
    body.grouping = std::make_shared<const Grouping>(make_grouping(body, std::move(group)));
  }
  /// Takes width and height in half-planes.
  template <class GroupOf>
  Bar(const Settings& given, int width, int height, const GroupOf& group_of)
      : Bar(given, test::fcc_box(width, width, height, r), group_of) {}

  Simulation begin(kernel::InstructionSet set = kernel::best_instruction_set()) const {
    return Simulation(body, motion_of(settings, body.skeleton), particles,
                      stepping_of(settings.solver, step), set);
  }
  Layer layer(std::size_t i) const { return body.grouping->layer[i]; }
  std::int32_t group(std::size_t i) const { return body.grouping->group[i]; }
};

inline Settings scene_of(MaterialModel model, DampingForm form = DampingForm::paper,
                         Precision precision = Precision::binary64) {
  Settings settings = test::in(precision, test::box_scene(41));
  settings.material.model = model;
  settings.material.damping_form = form;
  return settings;
}

struct Conserved {
  Vec3 momentum = Vec3::Zero(), angular = Vec3::Zero();
};

inline Conserved conserved(const Particles& particles) {
  Conserved sum;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    sum.momentum += particles.velocity(i);
    sum.angular += particles.position(i).cross(particles.velocity(i));
  }
  return sum;
}

/// Two halves of a bar, far apart, that fly at each other; one of them may be free.
inline Bar colliding(Settings settings, bool first_is_free) {
  settings = test::unbound(settings);
  Points rest = test::fcc_box(17, 17, 41, r);
  const double s = half_plane_spacing(r), middle = 20.5 * s;
  std::erase_if(rest, [&](const Vec3& X) { return std::abs(X.z() - middle) < 2.1 * s; });
  Bar bar(settings, rest, [&](const Vec3& X) {
    return X.z() > middle ? 1 : first_is_free ? -1 : 0;
  });
  for (std::size_t i = 0; i < rest.size(); ++i)
    bar.particles.set_velocity(i,
                               rest[i].z() > middle ? Vec3(0.005, 0, -0.05) : Vec3(0, 0.002, 0.05));
  return bar;
}

inline Vec3 momentum(const Particles& particles, double above) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < particles.size(); ++i)
    if (particles.z[i] > above) sum += particles.velocity(i);
  return sum / static_cast<double>(particles.size());
}

/// Without damping, momentum stays, and so does energy, but for what waves and turns take.
inline void expect_elastic_collision(const Bar& bar) {
  Simulation simulation = bar.begin();
  const double middle = 20.5 * half_plane_spacing(r);
  const Vec3 all = momentum(simulation.particles(), -1);
  const double upper = momentum(simulation.particles(), middle).z();
  const double energy = simulation.energies().stored(), kinetic = simulation.energies().kinetic;
  while (simulation.time() < 1.2) simulation.step();
  EXPECT_LT((momentum(simulation.particles(), -1) - all).norm(), 1e-13);
  EXPECT_NEAR(simulation.energies().stored(), energy, 0.15 * kinetic);
  EXPECT_GT(momentum(simulation.particles(), middle).z(), 0.5 * upper);
}

/// The same bar, whose groups are cubic, or affine.
inline Bar with_cubic(Bar bar, bool cubic) {
  auto grouping = std::make_shared<Grouping>(*bar.body.grouping);
  grouping->cubic.assign(grouping->size(), cubic ? 1 : 0);
  bar.body.grouping = grouping;
  return bar;
}

inline double root_mean_square_distance(const Particles& a, const Particles& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a.position(i) - b.position(i)).squaredNorm();
  return std::sqrt(sum / static_cast<double>(a.size()));
}

/// How far a bent bar with groups is from one without, root mean square in radii.
inline double off_from_full(Bar bar, double duration) {
  Simulation grouped = bar.begin();
  bar.body.grouping.reset();
  Simulation full = bar.begin();
  while (grouped.time() < duration) grouped.step(), full.step();
  return root_mean_square_distance(grouped.particles(), full.particles()) / r;
}

}  // namespace sinew::groups_test
