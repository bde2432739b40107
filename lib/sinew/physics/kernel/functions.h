// SPDX-License-Identifier: GPL-3.0-or-later
// The kernel's functions for the instruction set of the source file that includes this.
#pragma once

#include <sinew/physics/kernel/pruning.h>
#include <sinew/physics/kernel/step.h>
#include <sinew/physics/kernel/survey.h>

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

template <class L, PairLaw pairs>
void step_flushed(const Step<typename L::Real>& step, std::size_t begin, std::size_t end) {
  const FlushedToZero<L> mode;
  step_pieces<L, pairs>(step, begin, end);
}

template <class L, PairLaw pairs>
void probe_flushed(const Step<typename L::Real>& step, std::size_t begin, std::size_t end) {
  const FlushedToZero<L> mode;
  probe_pieces<L, pairs>(step, begin, end);
}

template <class L>
void strain_flushed(const Step<typename L::Real>& step, std::size_t begin, std::size_t end) {
  const FlushedToZero<L> mode;
  strain_pieces<L>(step, begin, end);
}

template <class L>
constexpr Functions<typename L::Real> functions() {
  return {strain_flushed<L>,
          {step_flushed<L, between_all>, step_flushed<L, among_neighbors>, step_flushed<L, springs>,
           step_flushed<L, changing_springs>},
          {probe_flushed<L, between_all>, probe_flushed<L, among_neighbors>,
           probe_flushed<L, springs>, probe_flushed<L, changing_springs>},
          prune_range<L>,
          prune_list<L>,
          survey<L>};
}

}  // namespace sinew::kernel
