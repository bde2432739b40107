// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/groups/cubic/quadrature.h>

#include <algorithm>
#include <map>

#include <sinew/core/decompositions.h>
#include <sinew/groups/cubic/cubic_fits.h>
#include <sinew/groups/cubic/polynomials.h>

namespace sinew {
namespace {

constexpr std::size_t min_samples = 128;
// What has fewer is small, and what pulls it is nearly linear there.
constexpr std::size_t few_blocks = 512, min_of_few = 64;
constexpr double min_weight = 0.1, max_weight = 5;  // multiples of equal weights
constexpr int max_fits = 30;

/// The upper bits of a number that looks like chance: rows of a lattice repeat, samples must not.
std::uint64_t scattered(std::uint64_t number) {
  number = (number + 1) * 0x9E3779B97F4A7C15U;
  number = (number ^ number >> 31) * 0xBF58476D1CE4E5B9U;
  return number >> 32;
}

/// Finds moments of blocks in a frame of their own: in that of a group, those of a part of it would
/// be near to each other.
std::vector<QuarticTerms> moments_of(const std::vector<std::uint32_t>& blocks,
                                     const std::function<Points(std::uint32_t)>& places_of) {
  Points middles;
  for (const std::uint32_t block : blocks) {
    const Points places = places_of(block);
    Vec3& middle = middles.emplace_back(Vec3::Zero());
    for (const Vec3& at : places) middle += at / static_cast<double>(places.size());
  }
  const FitFrame frame(middles);
  std::vector<QuarticTerms> moments(blocks.size(), QuarticTerms::Zero());
  for (std::size_t n = 0; n < blocks.size(); ++n)
    for (const Vec3& at : places_of(blocks[n])) moments[n] += quartic_terms_at(frame.at(at));
  return moments;
}

struct Sample {
  std::size_t of;
  double weight;
};

/// Which of the moments of so many blocks are to be exact, from one block of how many.
struct Sampling {
  int terms;
  std::size_t stretch;
};

Sampling sampling_of(std::size_t blocks) {
  if (blocks < few_blocks) return {square_terms, std::max<std::size_t>(blocks / min_of_few, 1)};
  return {quartic_terms, 2 * stretch_of(blocks)};
}

/// More and more until they do, or until they are all.
std::vector<Sample> sample_of(const std::vector<QuarticTerms>& moments) {
  auto [terms, stretch] = sampling_of(moments.size());
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(terms);
  for (const QuarticTerms& one : moments) sum += one.head(terms);
  std::vector<Sample> chosen;
  for (;; stretch = std::max<std::size_t>(3 * stretch / 4, 1)) {
    chosen.clear();
    for (std::size_t n = 0; n < moments.size(); ++n)
      if (is_sample(n, stretch)) chosen.push_back({n, 1});
    Eigen::MatrixXd sampled(terms, static_cast<Eigen::Index>(chosen.size()));
    for (std::size_t s = 0; s < chosen.size(); ++s)
      sampled.col(static_cast<Eigen::Index>(s)) = moments[chosen[s].of].head(terms);
    const std::vector<double> weights = weights_of(sampled, sum, moments.size());
    for (std::size_t s = 0; s < weights.size(); ++s) chosen[s].weight = weights[s];
    if (!weights.empty()) return chosen;
  }
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

std::size_t stretch_of(std::size_t count) { return std::max<std::size_t>(count / min_samples, 1); }

bool is_sample(std::size_t n, std::size_t stretch) {
  return n % stretch == scattered(n / stretch) % stretch;
}

/// What would become too small is set to the least weight, and the others are found again.
std::vector<double> weights_of(const Eigen::MatrixXd& samples, const Eigen::VectorXd& all,
                               std::size_t count) {
  if (samples.cols() == static_cast<Eigen::Index>(count)) return std::vector<double>(count, 1);
  if (samples.cols() == 0) return {};
  const double even = static_cast<double>(count) / static_cast<double>(samples.cols());
  Eigen::VectorXd weights = Eigen::VectorXd::Constant(samples.cols(), even);
  Eigen::MatrixXd free = samples;
  for (int round = 0; round < max_fits; ++round) {
    const Eigen::VectorXd missing = all - samples * weights;
    weights += best_fit(free, missing);
    bool any = false;
    for (Eigen::Index s = 0; s < weights.size(); ++s) {
      if (weights[s] >= min_weight * even) continue;
      any = any || weights[s] < min_weight * even * (1 - 1e-9);
      weights[s] = min_weight * even;
      free.col(s).setZero();
    }
    if (any) continue;
    const double off = (samples * weights - all).cwiseAbs().maxCoeff();
    if (off < 1e-9 * all[0] && weights.maxCoeff() < max_weight * even)
      return {weights.begin(), weights.end()};
    break;
  }
  return {};
}

Quadrature quadrature_over(const std::vector<SampledBlock>& blocks,
                           const std::function<Points(std::uint32_t)>& places_of) {
  std::map<std::uint64_t, std::vector<std::uint32_t>> kinds;
  for (const SampledBlock& one : blocks) kinds[one.kind].push_back(one.block);
  std::vector<std::pair<std::uint32_t, double>> chosen;
  for (const auto& [kind, all] : kinds)
    for (const auto& [n, weight] : sample_of(moments_of(all, places_of)))
      chosen.emplace_back(all[n], weight);
  std::sort(chosen.begin(), chosen.end());
  Quadrature quadrature;
  for (const auto& [block, weight] : chosen) {
    quadrature.block.push_back(block);
    quadrature.weight.push_back(weight);
  }
  return quadrature;
}

}  // namespace sinew
