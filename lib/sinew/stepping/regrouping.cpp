// SPDX-License-Identifier: GPL-3.0-or-later
// How a simulation changes its groups of particles. All depends on the count of steps and on the
// state alone, so that a resumed run does the same.
#include <algorithm>
#include <cmath>
#include <utility>

#include <sinew/core/error.h>
#include <sinew/stepping/simulation.h>

namespace sinew {
namespace {

constexpr std::int64_t steps_between_checks = 32;
// Looking for what may join takes as long as many steps within groups do.
constexpr std::int64_t steps_between_merges = 512;
constexpr double least_gain = 0.05;  // of the particles, in groups

std::size_t count_grouped(const std::vector<std::int32_t>& group) {
  return static_cast<std::size_t>(
      std::count_if(group.begin(), group.end(), [](std::int32_t one) { return one >= 0; }));
}

/// Of so many particles, in groups.
std::size_t worthwhile(std::size_t count) {
  return static_cast<std::size_t>(std::ceil(least_gain * static_cast<double>(count)));
}

}  // namespace

void Simulation::group_as_it_moves(const DynamicOptions& options) {
  if (std::holds_alternative<CellStepper>(stepper_))
    throw bad_input("the paper's cells have no groups", "search neighbors by lists");
  check_groupable(*body_);
  move_in(std::vector<std::int32_t>(body_->rest.size(), -1));
  dynamic_.emplace(body_, *motion_, particles_.mass, options);
  regrouping_.still_since.assign(body_->skeleton.size(), -1);
  regroup({}, false);
}

void Simulation::set_grouping(std::vector<std::int32_t> group) {
  if (group.size() != body_->rest.size()) throw not_a_state("it has no groups");
  body_->grouping = std::make_shared<const Grouping>(make_grouping(
      *body_, std::move(group), dynamic_ ? dynamic_->options().sizes.cubic_from() : none_cubic));
}

void Simulation::restore_grouping(const SimulationState& state) {
  const RegroupingState& groups = state.regrouping;
  const bool known = std::all_of(groups.still_since.begin(), groups.still_since.end(),
                                 [](double since) { return is_computable(since); });
  if (groups.still_since.size() != body_->skeleton.size() || !known || groups.times < 0 ||
      !is_computable(groups.lost))
    throw not_a_state("its groups are of another skeleton");
  set_grouping(state.grouping);
  regrouping_ = groups;
}

/// The particles go on in these groups, from where they are.
void Simulation::move_in(std::vector<std::int32_t> group) {
  set_grouping(std::move(group));
  std::visit(
      [](auto& stepper) {
        if constexpr (requires { stepper.regroup(); }) stepper.regroup();
      },
      stepper_);
  evaluated_ = false;
  forget_read();
}

GroupingMoment Simulation::grouping_moment() const {
  return {time(), static_cast<double>(steps_between_checks) * stepping_.step,
          regrouping_.still_since};
}

/// After a step.
void Simulation::check_groups() {
  if (!dynamic_ || steps_ % steps_between_checks != 0) return;
  std::vector<HeldCell> held;
  std::visit(
      [&](auto& stepper) {
        if constexpr (requires { stepper.regroup(); })
          held = stepper.held(dynamic_->cells(), dynamic_->cell_count());
      },
      stepper_);
  if (dynamic_->must_split(grouping_moment(), held)) return regroup(held, true);
  if (steps_ % steps_between_merges == 0 &&
      dynamic_->may_join(grouping_moment(), worthwhile(body_->rest.size())))
    regroup(held, false);
}

void Simulation::regroup(std::span<const HeldCell> held, bool must) {
  NewGroups made = dynamic_->regroup(grouping_moment(), held, particles());
  if (!must &&
      count_grouped(made.group) < body_->grouping->grouped() + worthwhile(made.group.size()))
    return;
  const double before = energies().stored();
  move_in(std::move(made.group));
  regrouping_.lost += before - energies().stored();
  regrouping_.still_since = std::move(made.still_since);
  ++regrouping_.times;
}

}  // namespace sinew
