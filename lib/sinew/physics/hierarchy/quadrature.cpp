// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/physics/hierarchy/quadrature.h>

#include <Eigen/Dense>
#include <algorithm>
#include <map>

#include <sinew/physics/hierarchy/polynomials.h>

namespace sinew {
namespace {

constexpr std::size_t least_samples = 256;
constexpr std::size_t most_blocks = 64;                // for one of them
constexpr double least_weight = 0.1, most_weight = 5;  // of an equal share
constexpr int most_fits = 30;

/// The upper bits of a number that looks like chance: rows of a lattice repeat, samples must not.
std::uint64_t scattered(std::uint64_t number) {
  number = (number + 1) * 0x9E3779B97F4A7C15U;
  number = (number ^ number >> 31) * 0xBF58476D1CE4E5B9U;
  return number >> 32;
}

}  // namespace

QuarticTerms quartic_terms_at(const Vec3& at) {
  const Terms terms = terms_at(at);
  QuarticTerms all;
  all.head<cubic_terms>() = terms;
  const double x = at[0], y = at[1], z = at[2];
  const auto cubes = terms.segment<10>(square_terms);  // xxx xxy xxz xyy xyz xzz yyy yyz yzz zzz
  all.segment<10>(cubic_terms) = x * cubes;
  all.segment<4>(cubic_terms + 10) = y * cubes.segment<4>(6);
  all[quartic_terms - 1] = z * cubes[9];
  return all;
}

std::size_t stretch_of(std::size_t count) {
  return std::max<std::size_t>(count / least_samples, 1);
}

bool is_sample(std::size_t n, std::size_t stretch) {
  return n % stretch == scattered(n / stretch) % stretch;
}

/// What would become too small is set to the least weight, and the others are found again.
std::vector<double> weights_of(const Eigen::MatrixXd& samples, const QuarticTerms& all,
                               std::size_t count) {
  if (samples.cols() == static_cast<Eigen::Index>(count)) return std::vector<double>(count, 1);
  if (samples.cols() == 0) return {};
  const double even = static_cast<double>(count) / static_cast<double>(samples.cols());
  Eigen::VectorXd weights = Eigen::VectorXd::Constant(samples.cols(), even);
  Eigen::MatrixXd free = samples;
  for (int round = 0; round < most_fits; ++round) {
    const QuarticTerms missing = all - samples * weights;
    weights += free.completeOrthogonalDecomposition().solve(missing);
    bool any = false;
    for (Eigen::Index s = 0; s < weights.size(); ++s) {
      if (weights[s] >= least_weight * even) continue;
      any = any || weights[s] < least_weight * even * (1 - 1e-9);
      weights[s] = least_weight * even;
      free.col(s).setZero();
    }
    if (any) continue;
    const double off = (samples * weights - all).cwiseAbs().maxCoeff();
    if (off < 1e-9 * all[0] && weights.maxCoeff() < most_weight * even)
      return {weights.begin(), weights.end()};
    break;
  }
  return {};
}

Quadrature quadrature_over(const std::vector<SampledBlock>& blocks,
                           const std::function<QuarticTerms(std::uint32_t)>& moments_of) {
  std::map<std::uint64_t, std::vector<std::uint32_t>> kinds;
  for (const SampledBlock& one : blocks) kinds[one.kind].push_back(one.block);
  std::vector<std::pair<std::uint32_t, double>> chosen;
  for (const auto& [kind, all] : kinds) {
    std::vector<std::uint32_t> sample;
    for (std::size_t n = 0; n < all.size(); ++n)
      if (is_sample(n, std::min(2 * stretch_of(all.size()), most_blocks))) sample.push_back(all[n]);
    QuarticTerms sum = QuarticTerms::Zero();
    for (const std::uint32_t block : all) sum += moments_of(block);
    Eigen::MatrixXd moments(quartic_terms, static_cast<Eigen::Index>(sample.size()));
    for (std::size_t s = 0; s < sample.size(); ++s)
      moments.col(static_cast<Eigen::Index>(s)) = moments_of(sample[s]);
    std::vector<double> weights = weights_of(moments, sum, all.size());
    if (weights.empty()) sample = all, weights.assign(all.size(), 1);
    for (std::size_t s = 0; s < sample.size(); ++s) chosen.emplace_back(sample[s], weights[s]);
  }
  std::sort(chosen.begin(), chosen.end());
  Quadrature quadrature;
  for (const auto& [block, weight] : chosen) {
    quadrature.block.push_back(block);
    quadrature.weight.push_back(weight);
  }
  return quadrature;
}

}  // namespace sinew
