// SPDX-License-Identifier: GPL-3.0-or-later
// Reads ahead, from memory into the caches: a body of some 100,000 particles does not fit into
// them, and lies in more streams, in farther steps, than the processor follows by itself.
#pragma once

#include <cstddef>

#include <sinew/kernel/vectors.h>

namespace sinew::kernel {

/// Where a pass will be soon.
struct Ahead {
  std::size_t block;
  std::ptrdiff_t own;       ///< its first particle
  std::ptrdiff_t farthest;  ///< the particle that a neighbor of the blocks in between may be
};

template <class Real>
SINEW_INLINE Ahead ahead_of(const Step<Real>& step, std::size_t block) {
  constexpr std::size_t blocks = 4;  // measured: 2 to 8 serve alike
  Ahead ahead;
  ahead.block = block + blocks < step.blocks ? block + blocks : step.blocks - 1;
  ahead.own = static_cast<std::ptrdiff_t>(ahead.block) * Traits<Real>::block;
  std::int32_t farthest = 0;
  const Lists& lists = step.lists[block / blocks_per_piece];
  const std::uint32_t* first = lists.first + block % blocks_per_piece;
  if (first[0] != first[1]) farthest = lists.value[first[1] - 1];
  if (step.bonds.first != nullptr && step.bonds.first[block] != step.bonds.first[block + 1]) {
    const std::int32_t last = step.bonds.entries[step.bonds.first[block + 1] - 1].difference;
    farthest = last > farthest ? last : farthest;
  }
  ahead.farthest = ahead.own + (farthest > 0 ? farthest : 0);
  return ahead;
}

/// Rows of a block.
template <class Real>
SINEW_INLINE void fetch_rows(const Real* rows, std::ptrdiff_t first, int count) {
  for (int k = 0; k < count; ++k) __builtin_prefetch(rows + (first + k) * Traits<Real>::block);
}

/// The bonds of a block.
template <class Real>
SINEW_INLINE void fetch_bonds(const Bonds<Real>& bonds, std::size_t block) {
  constexpr std::uint32_t of_a_line = 64 / sizeof(BondEntry);
  if (bonds.first == nullptr) return;
  for (std::uint32_t e = bonds.first[block]; e < bonds.first[block + 1]; e += of_a_line)
    __builtin_prefetch(bonds.entries + e);
}

template <class Real>
SINEW_INLINE void fetch_for_step(const Step<Real>& step, std::size_t block) {
  const Ahead ahead = ahead_of(step, block);
  for (int axis = 0; axis < 3; ++axis) {
    __builtin_prefetch(step.before.x[axis] + ahead.farthest);
    __builtin_prefetch(step.before.v[axis] + ahead.farthest);
    __builtin_prefetch(step.after.x[axis] + ahead.own, 1);
    __builtin_prefetch(step.after.v[axis] + ahead.own, 1);
  }
  const auto slot = static_cast<std::ptrdiff_t>(step.bindings.first[ahead.block]);
  fetch_rows(step.bindings.attachments, slot * attachment_fields, attachment_fields);
  fetch_bonds(step.bonds, ahead.block);
  if (step.volumes.stiffness != nullptr)
    for (int k = 0; k < 9; ++k) __builtin_prefetch(step.volumes.thrust[k] + ahead.farthest);
}

/// A block that bones pull without a step.
template <class Real>
SINEW_INLINE void fetch_for_pull(const Step<Real>& step, const PulledBlocks<Real>& pulled,
                                 std::size_t block) {
  const auto own = static_cast<std::ptrdiff_t>(block) * Traits<Real>::block;
  for (int axis = 0; axis < 3; ++axis) {
    __builtin_prefetch(step.before.x[axis] + own);
    __builtin_prefetch(step.before.v[axis] + own);
    __builtin_prefetch(pulled.at[axis] + own);
  }
  const auto slot = static_cast<std::ptrdiff_t>(step.bindings.first[block]);
  fetch_rows(step.bindings.attachments, slot * attachment_fields, attachment_fields);
}

template <class Real>
SINEW_INLINE void fetch_for_strain(const Step<Real>& step, std::size_t block) {
  const Ahead ahead = ahead_of(step, block);
  for (int axis = 0; axis < 3; ++axis) __builtin_prefetch(step.before.x[axis] + ahead.farthest);
  if (step.volumes.stiffness == nullptr) return;
  for (int k = 0; k < 6; ++k) __builtin_prefetch(step.inverse[k] + ahead.own);
  for (int k = 0; k < 9; ++k) __builtin_prefetch(step.volumes.thrust[k] + ahead.own, 1);
}

}  // namespace sinew::kernel
