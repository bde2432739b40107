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
/// Of a place, in units in which all of them are within about 1.
QuarticTerms quartic_terms_at(const Vec3& at);

/// Of so many, one of how many is a sample of them: of few, each.
std::size_t stretch_of(std::size_t count);
/// Whether the n-th is one.
bool is_sample(std::size_t n, std::size_t stretch);
/// Of samples of `count`, each a column: its moments; `all`: the sums over all. None where they
/// would differ much.
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

/// Of all blocks, ascending. `places_of`: its particles' places, in any frame. Kinds of few blocks
/// are small: their sums are exact to the second order.
Quadrature quadrature_over(const std::vector<SampledBlock>& blocks,
                           const std::function<Points(std::uint32_t)>& places_of);

}  // namespace sinew
