// SPDX-License-Identifier: GPL-3.0-or-later
// Sums over many blocks of particles from a sample of them: the weights are those nearest to equal
// ones with which the moments of places at rest up to the third are exact.
//
//     const Quadrature quadrature = quadrature_over(blocks);
//     sum += quadrature.weight[s] * value_of(quadrature.block[s]);
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <sinew/core/vector.h>

namespace sinew {

/// Of a block: the sums of 1, X, X X and X X X over its particles, each product once.
inline constexpr int block_moments = 20;
using BlockMoments = std::array<double, block_moments>;

/// Adds a particle at X, in units in which a group is about 1 large.
void add_moments(const Vec3& X, BlockMoments& moments);

/// A block of particles, and the kind of what pulls them: kinds are sampled apart.
struct SampledBlock {
  std::uint32_t block;
  std::uint64_t kind;
  BlockMoments moments;
};

struct Quadrature {
  std::vector<std::uint32_t> block;  ///< ascending
  std::vector<double> weight;
};

/// Of all blocks, ascending. Kinds of few blocks are summed whole.
Quadrature quadrature_over(const std::vector<SampledBlock>& blocks);

}  // namespace sinew
