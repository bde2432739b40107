// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/stepping/detail/dynamic_grouping.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <sinew/body/grouping.h>
#include <sinew/core/vector.h>

namespace sinew {
namespace {

constexpr std::int64_t steps_between_checks = 32;
// Looking for what may join takes as long as many steps within groups do.
constexpr std::int64_t steps_between_merges = 512;
constexpr double min_gain = 0.05;  // fraction of the particles, in groups

std::size_t count_grouped(const std::vector<std::int32_t>& group) {
  return static_cast<std::size_t>(
      std::count_if(group.begin(), group.end(), [](std::int32_t one) { return one >= 0; }));
}

/// Returns the fewest, of so many particles, that are worth grouping.
std::size_t worthwhile(std::size_t count) {
  return static_cast<std::size_t>(std::ceil(min_gain * static_cast<double>(count)));
}

}  // namespace

DynamicGrouping::DynamicGrouping(std::shared_ptr<const Body> body, const Motion& motion,
                                 double mass, const DynamicOptions& options)
    : body_(std::move(body)), groups_(body_, motion, mass, options) {
  state_.still_since.assign(body_->skeleton.size(), -1);
}

std::int64_t DynamicGrouping::steps_until_due(std::int64_t steps) {
  return steps_between_checks - steps % steps_between_checks;
}

bool DynamicGrouping::is_due(std::int64_t steps) { return steps % steps_between_checks == 0; }

GroupingMoment DynamicGrouping::moment(const Now& now) const {
  return {now.time, static_cast<double>(steps_between_checks) * now.step, state_.still_since};
}

std::optional<NewGroups> DynamicGrouping::changed(
    const Stepper& stepper, const Now& now,
    const std::function<const Particles&()>& particles) const {
  const std::vector<ConstrainedCell> constrained =
      stepper.constrained_cells(groups_.cells(), groups_.cell_count());
  if (groups_.must_split(moment(now), constrained))
    return groups_.regroup(moment(now), constrained, particles());
  if (now.steps % steps_between_merges == 0 &&
      groups_.may_join(moment(now), worthwhile(body_->rest.size())))
    return joined(now, constrained, particles());
  return std::nullopt;
}

std::optional<NewGroups> DynamicGrouping::first(const Now& now, const Particles& particles) const {
  return joined(now, {}, particles);
}

/// Where enough particles join.
std::optional<NewGroups> DynamicGrouping::joined(const Now& now,
                                                 std::span<const ConstrainedCell> constrained,
                                                 const Particles& particles) const {
  NewGroups made = groups_.regroup(moment(now), constrained, particles);
  if (count_grouped(made.group) < body_->grouping->grouped() + worthwhile(made.group.size()))
    return std::nullopt;
  return made;
}

void DynamicGrouping::took(NewGroups made, double lost) {
  state_.lost += lost;
  state_.still_since = std::move(made.still_since);
  ++state_.times;
}

Grouping DynamicGrouping::grouping_of(std::vector<std::int32_t> group) const {
  if (group.size() != body_->rest.size()) throw not_a_state("it has no groups");
  return make_grouping(*body_, std::move(group), groups_.options().sizes.cubic_from(),
                       groups_.neighbors());
}

void DynamicGrouping::restore(const RegroupingState& state) {
  const bool known = std::all_of(state.still_since.begin(), state.still_since.end(),
                                 [](double since) { return is_computable(since); });
  if (state.still_since.size() != body_->skeleton.size() || !known || state.times < 0 ||
      !is_computable(state.lost))
    throw not_a_state("its groups are of another skeleton");
  state_ = state;
}

}  // namespace sinew
