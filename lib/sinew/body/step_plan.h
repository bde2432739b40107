// SPDX-License-Identifier: GPL-3.0-or-later
// How a body is stepped, and when the steps of a run take place. They are equal, but where bones
// are fast for a moment: there each is divided into parts, the same number throughout an interval
// (from frame to frame), and in a last interval that is shorter than the others.
//
//     const StepPlan plan(choice, interval, {1, 1, 4, 1});
//     while (simulation.steps() < plan.steps_until(frame)) simulation.step();
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <sinew/core/options.h>
#include <sinew/core/vector.h>

namespace sinew {

struct Stepping {
  Integrator integrator = Integrator::symplectic_euler;
  double step = 0;              ///< s
  Vec3 gravity = Vec3::Zero();  ///< m/s^2
  Precision precision = Precision::binary64;
  NeighborSearch neighbor_search = NeighborSearch::lists;
};

// A bond that snaps drives a particle by (b - a) sqrt(k lambda / 3m) dt, 0.1 r at half the limit.
// Faster than several bonds at once is an unstable step, or a particle that snaps out between two
// parts that press on it: over a radius, at sqrt(k/m) r.
inline constexpr double max_radii_per_step = 0.25;

/// Steps of an interval before they are divided.
struct WholeSteps {
  int count = 0;
  double step = 0;  ///< s
};

class StepPlan {
 public:
  /// Equal steps, s.
  explicit StepPlan(double step = 0) : step_(step) {}
  /// Intervals of `per_interval` steps of `step` s, each divided into `parts` of the interval;
  /// after the last of them steps are whole. Where the last is shorter than the others, its steps.
  StepPlan(double step, int per_interval, std::vector<int> parts,
           std::optional<WholeSteps> last = {});

  bool is_even() const { return first_.empty(); }
  /// The size of step `n`, from 0, s.
  double step(std::int64_t n) const;
  /// The time before step `n`, s.
  double time(std::int64_t n) const;
  /// Steps before interval `index`. Only of a plan in intervals.
  std::int64_t steps_until(int index) const;
  /// Intervals that have begun before step `n`.
  int intervals_begun(std::int64_t n) const;

  /// The same with the steps of the first intervals divided into so many times as many. Only of a
  /// plan in intervals.
  StepPlan divided(const std::vector<int>& by) const;

  /// Into how many parts the steps of an interval are divided.
  int parts(int index) const;
  int max_parts() const;
  int divided() const;  ///< intervals of which the steps are
  const std::optional<WholeSteps>& last() const { return last_; }

 private:
  std::size_t interval_of(std::int64_t n) const;
  double whole_step(std::size_t interval) const;

  double step_ = 0;  ///< s, whole
  int per_interval_ = 0;
  std::vector<int> parts_;
  std::optional<WholeSteps> last_;
  std::vector<std::int64_t> first_;  ///< step of each interval, and of the end; none: all even
};

}  // namespace sinew
