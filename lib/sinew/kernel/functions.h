// SPDX-License-Identifier: GPL-3.0-or-later
// The kernel's functions for the instruction set of the source file that includes this.
#pragma once

#include <utility>

#include <sinew/kernel/group_motion.h>
#include <sinew/kernel/listing.h>
#include <sinew/kernel/momenta.h>
#include <sinew/kernel/moments.h>
#include <sinew/kernel/pruning.h>
#include <sinew/kernel/step.h>
#include <sinew/kernel/survey.h>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace sinew::kernel {

/// While it exists, denormal numbers count as zero: velocities that decay would otherwise make
/// every operation a hundred times slower.
template <class L>
class FlushedToZero {
 public:
#if defined(__SSE2__)
  FlushedToZero() : before_(_mm_getcsr()) { _mm_setcsr(before_ | flush_to_zero | tiny_are_zero); }
  ~FlushedToZero() { _mm_setcsr(before_); }

 private:
  static constexpr unsigned flush_to_zero = 0x8000, tiny_are_zero = 0x0040;
  unsigned before_;
#else
  FlushedToZero() = default;
  ~FlushedToZero() {}

 public:
#endif
  FlushedToZero(const FlushedToZero&) = delete;
  FlushedToZero& operator=(const FlushedToZero&) = delete;
};

template <class L, Work<typename L::Real> work>
void flushed(const Step<typename L::Real>& step, std::size_t begin, std::size_t end) {
  const FlushedToZero<L> mode;
  work(step, begin, end);
}

template <class L, int terms>
void flushed_pulls(const Step<typename L::Real>& step, const PulledBlocks<typename L::Real>& blocks,
                   PullSums& out) {
  const FlushedToZero<L> mode;
  pull_blocks<L, terms>(step, blocks, out);
}

template <class L, PairLaw pairs>
constexpr LawFunctions<typename L::Real> functions_of_law() {
  return {flushed<L, count_pieces<L, pairs>>,
          {flushed<L, step_pieces<L, pairs, forces_to_the_mean>>,
           flushed<L, step_pieces<L, pairs, forces_pairwise>>},
          {flushed<L, probe_pieces<L, pairs, forces_to_the_mean>>,
           flushed<L, probe_pieces<L, pairs, forces_pairwise>>}};
}

template <class L, int... pairs>
constexpr void add_laws(Functions<typename L::Real>& functions,
                        std::integer_sequence<int, pairs...>) {
  ((functions.law[pairs] = functions_of_law<L, PairLaw{pairs}>()), ...);
}

template <class L, Motions motions, int terms>
constexpr void add_groups(Functions<typename L::Real>& functions) {
  functions.put[motions] = put_group<lanes::Doubles, typename L::Real, terms>;
  functions.largest[motions] = largest_of_field<lanes::Doubles, terms>;
  functions.moments[motions] = sum_moments<L, terms>;
  functions.pull[motions] = flushed_pulls<L, terms>;
}

template <class L>
constexpr Functions<typename L::Real> functions() {
  Functions<typename L::Real> all{};
  all.strain = flushed<L, strain_pieces<L>>;
  all.flow = flushed<L, flow_pieces<L>>;
  add_groups<L, affine, affine_terms>(all);
  add_groups<L, cubic, cubic_terms>(all);
  all.pull_bonds = pull_group_bonds<lanes::Doubles, square_terms>;
  all.pull_ends = pull_group_bonds<lanes::Doubles, cubic_terms>;
  add_laws<L>(all, std::make_integer_sequence<int, pair_laws>());
  all.kept = kept_forces<L> * sizeof(Forces<L>);
  all.bound = bound_piece<lanes::Floats, typename L::Real>;
  all.list = list_two<lanes::Floats, typename L::Real>;
  all.prune = prune_list<L>;
  all.momenta = sum_momenta<lanes::Doubles, typename L::Real>;
  all.survey = survey<L>;
  return all;
}

}  // namespace sinew::kernel
