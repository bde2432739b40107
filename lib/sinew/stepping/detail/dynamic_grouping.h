// SPDX-License-Identifier: GPL-3.0-or-later
// How a simulation changes its groups of particles: when it looks, and what becomes of them. All
// depends on the count of steps and on the state alone, so that a resumed run does the same.
//
//     DynamicGrouping grouping(body, motion, mass, options);
//     if (grouping.is_due(steps)) next = grouping.changed(stepper, now, particles);
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <sinew/core/simulation_state.h>
#include <sinew/groups/dynamic/dynamic_groups.h>
#include <sinew/stepping/stepper.h>

namespace sinew {

/// State of groups of particles that change as the body moves.
struct RegroupingState {
  std::int64_t times = 0;  ///< how often they have
  double lost = 0;         ///< energy lost by merging, J
  /// Moment (s) from which each bone's joint with its parent counts as still; below 0: it moves.
  std::vector<double> still_since = {};
};

template <class Archive>
void serialize(Archive& archive, RegroupingState& state) {
  archive("times", state.times);
  archive("lost", state.lost);
  archive("still_since", state.still_since);
}

class DynamicGrouping {
 public:
  /// Takes a body without groups.
  DynamicGrouping(std::shared_ptr<const Body> body, const Motion& motion, double mass,
                  const DynamicOptions& options);

  struct Now {
    std::int64_t steps = 0;
    double time = 0, step = 0;  ///< s
  };

  /// Steps before it looks again.
  static std::int64_t steps_until_due(std::int64_t steps);
  static bool is_due(std::int64_t steps);
  /// New groups after so many steps, where they change; `particles`: of this moment.
  std::optional<NewGroups> changed(const Stepper& stepper, const Now& now,
                                   const std::function<const Particles&()>& particles) const;
  /// The first ones, where it is worthwhile.
  std::optional<NewGroups> first(const Now& now, const Particles& particles) const;
  /// The body has moved into new groups and has lost this energy (J).
  void took(NewGroups made, double lost);

  Grouping grouping_of(std::vector<std::int32_t> group) const;

  const RegroupingState& state() const { return state_; }
  /// Throws bad input for a state of another skeleton.
  void restore(const RegroupingState& state);

 private:
  GroupingMoment moment(const Now& now) const;
  std::optional<NewGroups> joined(const Now& now, std::span<const ConstrainedCell> constrained,
                                  const Particles& particles) const;

  std::shared_ptr<const Body> body_;
  DynamicGroups groups_;
  RegroupingState state_;
};

}  // namespace sinew
