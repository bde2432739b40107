// SPDX-License-Identifier: GPL-3.0-or-later
// Sums over many places from a sample of them: the weights are those nearest to equal ones with
// which the sums of all products of up to four coordinates are exact.
//
//     const Quadrature quadrature = quadrature_over(blocks, places_of);
//     sum += quadrature.weight[s] * value_of(quadrature.block[s]);
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include <sinew/core/vector.h>

namespace sinew {

inline constexpr int quartic_terms = 35;
/// The terms of polynomials.h, then those of the fourth degree.
using QuarticTerms = Eigen::Matrix<double, quartic_terms, 1>;
/// Returns the terms of a place, in units in which all places are within about 1.
QuarticTerms quartic_terms_at(const Vec3& at);

/// Returns how many of `count` there are to a sample: 1 if they are few.
std::size_t stretch_of(std::size_t count);
/// Whether the n-th is one.
bool is_sample(std::size_t n, std::size_t stretch);
/// Weighs samples of `count`, each a column: its moments; `all`: the sums over all. None where the
/// weights would differ much.
std::vector<double> weights_of(const Eigen::MatrixXd& samples, const Eigen::VectorXd& all,
                               std::size_t count);

/// A block of particles, and the kind of what pulls them: kinds are sampled apart.
struct SampledBlock {
  std::uint32_t block;
  std::uint64_t kind;
};

struct Quadrature {
  std::vector<std::uint32_t> block;  ///< ascending
  std::vector<double> weight;
};

/// Samples all blocks, ascending. `places_of`: places of a block's particles, in any frame. Kinds
/// of few blocks are small: their sums are exact to the second order.
Quadrature quadrature_over(const std::vector<SampledBlock>& blocks,
                           const std::function<Points(std::uint32_t)>& places_of);

}  // namespace sinew
