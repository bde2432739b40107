// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/world/sliding_contacts.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <sinew/core/simulation_state.h>

namespace sinew {
namespace {

// Fractions of the contact's own stiffness k, and of sqrt(k m).
constexpr double softer_across = 0.5, damped_across = 0.25;
constexpr double beyond_second = 3.1;  // in radii; second neighbors of a lattice are 2.83 apart

Vec3 across(const Vec3& normal, const Vec3& v) { return v - v.dot(normal) * normal; }

}  // namespace

SlidingContacts::SlidingContacts(const Body& body)
    : body_(&body),
      friction_(body.material.friction),
      stiffness_(softer_across * body.material.pair.contact_stiffness()),
      damping_(damped_across *
               std::sqrt(body.material.pair.contact_stiffness() * body.material.mass)),
      apart_at_rest_(beyond_second * body.material.pair.r) {
  if (friction_ > 0) stretched_.resize(body.rest.size());
}

bool SlidingContacts::rub(std::int32_t a, std::int32_t b) const {
  const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
  return (body_->rest[i] - body_->rest[j]).norm() > apart_at_rest_ && !pass_through(*body_, i, j);
}

/// Returns the stretch as long as it was, across the contact as it is now.
Vec3 SlidingContacts::stretch_of(std::int32_t id, const Touch& touch) const {
  const std::vector<Spring>& springs = stretched_[static_cast<std::size_t>(id)];
  const auto found = std::find_if(springs.begin(), springs.end(), [&](const Spring& spring) {
    return spring.other == touch.other;
  });
  if (found == springs.end()) return Vec3::Zero();
  const Vec3 turned = across(touch.normal, found->stretch);
  const double length = turned.norm();
  return length > 0 ? Vec3(found->stretch.norm() / length * turned) : turned;
}

Vec3 SlidingContacts::force(std::int32_t id, std::span<const Touch> touches, double step,
                            bool keep) {
  Vec3 sum = Vec3::Zero();
  std::vector<Spring> springs;
  for (const Touch& touch : touches) {
    const Vec3 sliding = across(touch.normal, touch.velocity);
    const Vec3 stretch = stretch_of(id, touch) + step * sliding;
    Vec3 force = -stiffness_ * stretch - damping_ * sliding;
    const double most = friction_ * touch.pressing, wanted = force.norm();
    const bool slips = wanted > most;
    if (slips) force *= most / wanted;
    sum += force;
    if (keep) springs.push_back({touch.other, slips ? Vec3(-force / stiffness_) : stretch});
  }
  if (keep) stretched_[static_cast<std::size_t>(id)] = std::move(springs);
  return sum;
}

void SlidingContacts::save(SimulationState& state) const {
  std::vector<std::int32_t> pairs;  // two ids each
  std::vector<double> stretches;    // three numbers each, m
  for (std::size_t id = 0; id < stretched_.size(); ++id)
    for (const Spring& spring : stretched_[id]) {
      pairs.insert(pairs.end(), {static_cast<std::int32_t>(id), spring.other});
      stretches.insert(stretches.end(), spring.stretch.begin(), spring.stretch.end());
    }
  put_column(state, "friction", "pairs", std::move(pairs));
  put_column(state, "friction", "stretches", std::move(stretches));
}

void SlidingContacts::restore(const SimulationState& state) {
  const auto pairs = column_of<std::int32_t>(state, "friction", "pairs");
  const auto stretches = column_of<double>(state, "friction", "stretches");
  const std::size_t springs = pairs.size() / 2;
  const auto known = [&](std::int32_t id) {
    return id >= 0 && static_cast<std::size_t>(id) < stretched_.size();
  };
  if (stretches.size() != 3 * springs || pairs.size() != 2 * springs ||
      !std::all_of(pairs.begin(), pairs.end(), known) || !all_finite(stretches))
    throw not_a_state("it has contacts of other particles");
  for (std::vector<Spring>& one : stretched_) one.clear();
  for (std::size_t k = 0; k < springs; ++k)
    stretched_[static_cast<std::size_t>(pairs[2 * k])].push_back(
        {pairs[2 * k + 1], Vec3(stretches.data() + 3 * k)});
}

}  // namespace sinew
