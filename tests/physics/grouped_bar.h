// SPDX-License-Identifier: GPL-3.0-or-later
// Bars of particles in groups.
#pragma once

#include <sinew/physics/hierarchy/grouping.h>

#include "all_steppers.h"

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
  /// Of half-planes.
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

/// How far a bent bar with groups is from one without, root mean square in radii.
inline double off_from_full(Bar bar, double duration) {
  Simulation grouped = bar.begin();
  bar.body.grouping.reset();
  Simulation full = bar.begin();
  while (grouped.time() < duration) grouped.step(), full.step();
  const Particles &a = grouped.particles(), &b = full.particles();
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a.position(i) - b.position(i)).squaredNorm();
  return std::sqrt(sum / static_cast<double>(a.size())) / r;
}

}  // namespace sinew::groups_test
