// SPDX-License-Identifier: GPL-3.0-or-later
// What bones exert on groups: sums over a sample of their idle blocks (quadrature.h). These are
// kept next to each other in memory, with all that a step reads of them: in the body they are far
// apart, and each would have to be fetched anew.
//
//     PulledSample<Real> sample(quadrature, particles);
//     if (!sample.is_bound()) sample.bind(step.bindings);
//     for (const PulledRun& run : sample.runs())  // in parallel
//       sums.push_back(sample.pull(run, kernel::cubic, kernel, step, motion_of(run.group)));
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <sinew/core/lines.h>
#include <sinew/groups/cubic/inner_forces.h>
#include <sinew/groups/cubic/quadrature.h>
#include <sinew/kernel/kernel.h>
#include <sinew/lists/block_state.h>

namespace sinew {

/// Samples [begin, end), all of one group.
struct PulledRun {
  std::uint32_t begin, end;
  std::int32_t group;
};

template <class Real>
class PulledSample {
 public:
  PulledSample() = default;
  /// Samples blocks each of which is of one group.
  PulledSample(Quadrature quadrature, const InnerParticles& particles);

  const std::vector<PulledRun>& runs() const { return runs_; }
  /// Copies how its particles are bound to bones from those of the body.
  void bind(const kernel::Bindings<Real>& body);
  bool is_bound() const { return !bindings_first_.empty(); }
  /// Moves a run's particles to where the group's motion (in the kernel's units) brings them, and
  /// sums up what the bones exert there. For each run once at a time.
  kernel::PullSums pull(const PulledRun& run, kernel::Motions motions,
                        const kernel::Functions<Real>& kernel, const kernel::Step<Real>& step,
                        const GroupMotion& motion);

 private:
  static constexpr std::size_t block = BlockState<Real>::block;

  Quadrature quadrature_;
  std::vector<PulledRun> runs_;
  std::vector<std::uint32_t> number_;  ///< number of each sample's block here
  std::array<std::vector<double>, 3> at_;
  std::array<Lines<Real>, 3> at_of_kernel_;
  BlockState<Real> state_;
  std::vector<std::uint32_t> bindings_first_;
  std::vector<kernel::Slot> slots_;
  Lines<Real> attachments_, weights_;
};

}  // namespace sinew
