// SPDX-License-Identifier: GPL-3.0-or-later
// Pairs of particles that pass through each other (body/pass_through.h), in the kernel's order:
// lists leave them out, so that the kernel never meets them.
//
//     const PassingPairs passing(body, layout.id());
//     if (passing.any()) passing.remove<Real>(piece, lists);
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <sinew/body/body.h>
#include <sinew/lists/offset_lists.h>

namespace sinew {

class PassingPairs {
 public:
  PassingPairs() = default;
  /// The body must outlive it; `id` in the kernel's order.
  PassingPairs(const Body& body, std::span<const std::int32_t> id);

  bool any() const { return body_ != nullptr; }
  /// Removes their lanes from the lists of a piece, all of whose differences have lanes then.
  template <class Real>
  void remove(std::size_t piece, OffsetLists& lists) const;

 private:
  bool pass(std::size_t i, std::size_t j) const;

  const Body* body_ = nullptr;  ///< none: nothing passes
  double near2_ = 0;            ///< square of near_at_rest()
  std::vector<std::int32_t> id_;
  std::vector<std::int32_t> bone_;  ///< bones of particles that pass through some; else -1
};

}  // namespace sinew
