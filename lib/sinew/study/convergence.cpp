// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/study/convergence.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <sinew/core/decompositions.h>

namespace sinew {
namespace {

constexpr double clearly_better = 5;          // spread about one term over a parabola's
constexpr std::size_t to_weigh_parabola = 6;  // sizes: what Akaike's correction needs, and one
constexpr double outweighing = 0.95;

struct Sample {
  double size, value;
};

std::vector<Sample> ascending(std::span<const double> sizes, std::span<const double> values) {
  std::vector<Sample> samples;
  for (std::size_t i = 0; i < sizes.size(); ++i) samples.push_back({sizes[i], values[i]});
  std::sort(samples.begin(), samples.end(),
            [](const Sample& a, const Sample& b) { return a.size < b.size; });
  return samples;
}

/// A limit and some powers of the size by least squares.
struct SizeFit {
  double at_zero;
  double spread;          ///< standard deviation of the residuals; 0 where it meets all values
  double standard_error;  ///< standard error of at_zero
  Eigen::Index free;      ///< values beyond those that it needs
};

SizeFit fitted(std::span<const Sample> samples, const std::vector<int>& powers) {
  const auto rows = static_cast<Eigen::Index>(samples.size());
  const auto columns = static_cast<Eigen::Index>(powers.size());
  Eigen::MatrixXd terms = Eigen::MatrixXd::Ones(rows, columns + 1);
  Eigen::VectorXd values(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const Sample& sample = samples[static_cast<std::size_t>(i)];
    for (Eigen::Index k = 0; k < columns; ++k)
      terms(i, k + 1) =
          std::pow(sample.size / samples.back().size, powers[static_cast<std::size_t>(k)]);
    values[i] = sample.value;
  }
  const Eigen::VectorXd found = best_fit(terms, values);
  const Eigen::Index free = rows - columns - 1;
  if (free == 0) return {found[0], 0, 0, free};
  const double variance = (terms * found - values).squaredNorm() / static_cast<double>(free);
  // Row of A's pseudoinverse: what each value adds to found[0].
  const Eigen::VectorXd unit = Eigen::VectorXd::Unit(columns + 1, 0);
  const double per_variance = best_fit(terms.transpose(), unit).squaredNorm();
  return {found[0], std::sqrt(variance), std::sqrt(variance * per_variance), free};
}

/// Student's t that 19 of 20 values do not exceed: Cornish and Fisher's series (Abramowitz and
/// Stegun 26.7.5), and the table where that is too short.
double student_t(Eigen::Index free) {
  if (free == 1) return 12.706;
  if (free == 2) return 4.303;
  constexpr double x = 1.95996, cube = x * x * x, fifth = cube * x * x;
  const auto n = static_cast<double>(free);
  return x + (cube + x) / (4 * n) + (5 * fifth + 16 * cube + 3 * x) / (96 * n * n) +
         (3 * fifth * x * x + 19 * fifth + 17 * cube - 15 * x) / (384 * n * n * n);
}

/// Half of what tells fits apart: of the likelihood's logarithm, less the price of parameters.
double evidence(const SizeFit& fit, double values, double rounding) {
  const double parameters = values - static_cast<double>(fit.free) + 1;
  const double squares = static_cast<double>(fit.free) * fit.spread * fit.spread;
  const double few = values < static_cast<double>(to_weigh_parabola)
                         ? 0
                         : parameters * (parameters + 1) / (values - parameters - 1);
  return -values / 2 * std::log(squares + rounding * rounding) - parameters - few;
}

/// The mean of fits weighted by their evidence; orders: theirs.
ContinuumLimit weighed(const std::vector<SizeFit>& fits, double values, double rounding) {
  std::vector<double> weight;
  for (const SizeFit& fit : fits) weight.push_back(evidence(fit, values, rounding));
  const double most = *std::max_element(weight.begin(), weight.end());
  double sum = 0;
  for (double& one : weight) sum += one = std::exp(one - most);
  ContinuumLimit limit{0, 0, not_measured};
  for (std::size_t k = 0; k < fits.size(); ++k) limit.value += weight[k] / sum * fits[k].at_zero;
  for (std::size_t k = 0; k < fits.size(); ++k) {
    const double off = fits[k].at_zero - limit.value, t = student_t(fits[k].free);
    limit.error +=
        weight[k] / sum * t * t * (fits[k].standard_error * fits[k].standard_error + off * off);
  }
  limit.error = std::sqrt(limit.error);
  for (std::size_t k = 0; k < 2; ++k)
    if (weight[k] > outweighing * sum) limit.order = static_cast<double>(k + 1);
  return limit;
}

/// What (f3 - f2) / (f2 - f1) is for values that differ from the limit by size^order.
double ratio_of(const Sample* s, double order) {
  const auto power = [&](const Sample& one) { return std::pow(one.size / s[2].size, order); };
  return (power(s[2]) - power(s[1])) / (power(s[1]) - power(s[0]));
}

/// Bisects: the ratio ascends with the order.
double order_of(const Sample* s) {
  constexpr double least = 0.05, most = 10;
  constexpr int halvings = 60;
  const double wanted = (s[2].value - s[1].value) / (s[1].value - s[0].value);
  if (!(wanted > ratio_of(s, least)) || !(wanted < ratio_of(s, most))) return not_measured;
  double low = least, high = most;
  for (int k = 0; k < halvings; ++k) {
    const double middle = (low + high) / 2;
    (ratio_of(s, middle) < wanted ? low : high) = middle;
  }
  return (low + high) / 2;
}

/// Returns the rounding of the values, in their unit.
double rounding_of(const std::vector<Sample>& samples) {
  double most = 0;
  for (const Sample& sample : samples) most = std::max(most, std::abs(sample.value));
  return 1e-14 * most;
}

double extrapolated(const Sample* s, double order) {
  const double step = std::pow(s[1].size / s[0].size, order) - 1;
  return s[0].value + (s[0].value - s[1].value) / step;
}

}  // namespace

std::vector<double> largest_of_one_sign(std::span<const std::vector<double>> runs) {
  const auto farthest = [&](double sign) {
    std::vector<double> found;
    for (const std::vector<double>& run : runs) {
      found.push_back(not_measured);
      for (const double value : run)
        if (std::isfinite(value) && !(sign * value <= sign * found.back())) found.back() = value;
    }
    return found;
  };
  const auto sum = [](const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0, [](double total, double value) {
      return std::isfinite(value) ? total + value : total;
    });
  };
  std::vector<double> high = farthest(1), low = farthest(-1);
  return sum(high) + sum(low) < 0 ? low : high;
}

namespace {

/// Whether the values tell of this limit.
bool approach(const std::vector<Sample>& samples, const ContinuumLimit& limit) {
  constexpr double doubtful = 0.2, beyond_first_order = 2;
  double largest = 0, low = samples.front().value, high = low;
  for (const Sample& sample : samples) {
    largest = std::max(largest, std::abs(sample.value));
    low = std::min(low, sample.value), high = std::max(high, sample.value);
  }
  if (limit.error <= doubtful * largest || samples.size() == 2) return true;
  const double finest = samples.front().size, coarsest = samples.back().size;
  const double by_first_order = (high - low) * finest / (coarsest - finest);
  return limit.error <= largest &&
         std::abs(limit.value - samples.front().value) <= beyond_first_order * by_first_order;
}

/// The limit that the values have if they approach one.
ContinuumLimit extrapolated(const std::vector<Sample>& samples) {
  const Sample* s = samples.data();
  const double finest = extrapolated(s, 1);
  if (samples.size() == 2) return {finest, std::abs(finest - s[0].value), not_measured};
  const SizeFit line = fitted(samples, {1}), square = fitted(samples, {2});
  const SizeFit parabola = fitted(samples, {1, 2});
  const SizeFit& better = line.spread <= square.spread ? line : square;
  const bool many = samples.size() >= to_weigh_parabola;
  if (samples.size() > 3 && (many || parabola.spread > better.spread / clearly_better)) {
    std::vector<SizeFit> fits = {line, square};
    if (many) fits.push_back(parabola);
    return weighed(fits, static_cast<double>(samples.size()), rounding_of(samples));
  }
  const double value = parabola.at_zero;
  ContinuumLimit limit{value, 0, order_of(s)};
  if (samples.size() > 3) {
    limit.error = std::max(student_t(parabola.free) * parabola.standard_error,
                           std::abs(value - better.at_zero));
    return limit;
  }
  limit.error = std::abs(value - line.at_zero);
  limit.error = std::max(limit.error, std::abs(value - finest));
  if (limit.order >= 0.5 && limit.order <= 3)
    limit.error = std::max(limit.error, std::abs(value - extrapolated(s, limit.order)));
  return limit;
}

}  // namespace

ContinuumLimit continuum_limit(std::span<const double> sizes, std::span<const double> values) {
  const auto missing = [](double value) { return !std::isfinite(value); };
  if (sizes.size() < 2 || std::any_of(values.begin(), values.end(), missing)) return {};
  const std::vector<Sample> samples = ascending(sizes, values);
  const ContinuumLimit limit = extrapolated(samples);
  return approach(samples, limit) ? limit : ContinuumLimit{};
}

ContinuumLimit within(const ContinuumLimit& limit, const ValueRange& range) {
  const double inside = std::clamp(limit.value, range.low, range.high);
  if (!(std::abs(limit.value - inside) <= limit.error)) return {};
  return {inside, limit.error, limit.order};
}

}  // namespace sinew
