// SPDX-License-Identifier: GPL-3.0-or-later
// How much a body is strained from one equilibrium to the next.
//
//     StrainMeter meter(body);
//     meter.begin(at_rest);
//     const IncrementStrain found = meter.since(positions);
#pragma once

#include <cstddef>

#include <sinew/body/body.h>
#include <sinew/core/deformation.h>
#include <sinew/stepping/equilibrium.h>

namespace sinew {

class StrainMeter {
 public:
  StrainMeter(const Body& body, const RestNeighbors& near);

  /// The positions, by id, from which strain counts (n x 3, m).
  void begin(Points positions);
  std::size_t inverted_at_begin() const { return inverted_; }
  /// Finds the strain since then, of pairs that were neighbors at rest and still are. Where bonds
  /// break or flow, or particles change neighbors, it leaves out the hundredth of the pairs that
  /// changed most. In parallel.
  IncrementStrain since(const Points& positions) const;

 private:
  std::size_t inverted_in(const Points& positions) const;

  RestShape shape_;
  bool all_count_;  ///< all pairs count
  double range_;    ///< beyond which a pair has parted, m
  Points begin_;
  std::size_t inverted_ = 0;
};

}  // namespace sinew
