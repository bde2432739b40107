// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/physics/hierarchy/quadrature.h>

#include <Eigen/Dense>
#include <algorithm>
#include <map>

namespace sinew {
namespace {

// Of a kind, at most one block in so many, but no fewer than these in all.
constexpr std::size_t most_per_sample = 64, least_samples = 256;
constexpr double least_weight = 0.1, most_weight = 4;  // of an equal share

/// The upper bits of a number that looks like chance: rows of a lattice repeat, samples must not.
std::uint64_t scattered(std::uint64_t number) {
  number = (number + 1) * 0x9E3779B97F4A7C15U;
  number = (number ^ number >> 31) * 0xBF58476D1CE4E5B9U;
  return number >> 32;
}

using Members = std::vector<const SampledBlock*>;

/// One of each stretch of blocks.
Members sample_of(const Members& all) {
  const std::size_t stretch = std::min(all.size() / least_samples, most_per_sample);
  Members sample;
  for (std::size_t begin = 0; begin < all.size(); begin += stretch) {
    const std::size_t length = std::min(stretch, all.size() - begin);
    sample.push_back(all[begin + scattered(begin) % length]);
  }
  return sample;
}

Eigen::VectorXd moments_of(const SampledBlock& block) {
  return Eigen::Map<const Eigen::VectorXd>(block.moments.data(), block_moments);
}

/// None where no good ones exist.
std::vector<double> weights_of(const Members& sample, const Members& all) {
  const auto count = static_cast<Eigen::Index>(sample.size());
  const double even = static_cast<double>(all.size()) / static_cast<double>(sample.size());
  Eigen::MatrixXd of_sample(block_moments, count);
  for (Eigen::Index s = 0; s < count; ++s)
    of_sample.col(s) = moments_of(*sample[static_cast<std::size_t>(s)]);
  Eigen::VectorXd wanted = Eigen::VectorXd::Zero(block_moments);
  for (const SampledBlock* block : all) wanted += moments_of(*block);
  const Eigen::VectorXd missing = wanted - even * of_sample.rowwise().sum();
  const Eigen::VectorXd weights =
      of_sample.completeOrthogonalDecomposition().solve(missing).array() + even;
  const double off = (of_sample * weights - wanted).cwiseAbs().maxCoeff();
  if (!(off < 1e-9 * wanted[0]) || weights.minCoeff() < least_weight * even ||
      weights.maxCoeff() > most_weight * even)
    return {};
  return {weights.begin(), weights.end()};
}

}  // namespace

void add_moments(const Vec3& X, BlockMoments& moments) {
  int at = 0;
  moments[at++] += 1;
  for (int i = 0; i < 3; ++i) {
    moments[at++] += X[i];
    for (int j = i; j < 3; ++j) {
      moments[at++] += X[i] * X[j];
      for (int k = j; k < 3; ++k) moments[at++] += X[i] * X[j] * X[k];
    }
  }
}

Quadrature quadrature_over(const std::vector<SampledBlock>& blocks) {
  std::map<std::uint64_t, Members> kinds;
  for (const SampledBlock& block : blocks) kinds[block.kind].push_back(&block);
  std::vector<std::pair<std::uint32_t, double>> chosen;
  for (const auto& [kind, all] : kinds) {
    Members sample = all;
    std::vector<double> weights;
    if (all.size() >= 2 * least_samples) {
      sample = sample_of(all);
      weights = weights_of(sample, all);
    }
    if (weights.empty()) sample = all, weights.assign(all.size(), 1);
    for (std::size_t s = 0; s < sample.size(); ++s)
      chosen.emplace_back(sample[s]->block, weights[s]);
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
