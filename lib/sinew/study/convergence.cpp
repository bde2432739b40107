// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/study/convergence.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

namespace sinew {
namespace {

constexpr double clearly_better = 5;  // of a parabola, by the spread about a line

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

/// A polynomial by least squares.
struct Polynomial {
  double at_zero;
  double spread;          ///< standard deviation of the residuals; 0 where it meets all values
  double standard_error;  ///< of at_zero
};

Polynomial fitted(std::span<const Sample> samples, Eigen::Index degree) {
  const auto rows = static_cast<Eigen::Index>(samples.size());
  Eigen::MatrixXd powers(rows, degree + 1);
  Eigen::VectorXd values(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const Sample& sample = samples[static_cast<std::size_t>(i)];
    double power = 1;
    for (Eigen::Index k = 0; k <= degree; ++k, power *= sample.size / samples.back().size)
      powers(i, k) = power;
    values[i] = sample.value;
  }
  const Eigen::VectorXd found = powers.colPivHouseholderQr().solve(values);
  const Eigen::Index free = rows - degree - 1;
  if (free == 0) return {found[0], 0, 0};
  const double variance = (powers * found - values).squaredNorm() / static_cast<double>(free);
  const Eigen::MatrixXd inverse = (powers.transpose() * powers).inverse();
  return {found[0], std::sqrt(variance), std::sqrt(variance * inverse(0, 0))};
}

/// What (f3 - f2) / (f2 - f1) is for values that differ from the limit by size^order.
double ratio_of(const Sample* s, double order) {
  const auto power = [&](const Sample& one) { return std::pow(one.size / s[2].size, order); };
  return (power(s[2]) - power(s[1])) / (power(s[1]) - power(s[0]));
}

/// By bisection: the ratio ascends with the order.
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

double extrapolated(const Sample* s, double order) {
  const double step = std::pow(s[1].size / s[0].size, order) - 1;
  return s[0].value + (s[0].value - s[1].value) / step;
}

}  // namespace

ContinuumLimit continuum_limit(std::span<const double> sizes, std::span<const double> values) {
  const auto missing = [](double value) { return !std::isfinite(value); };
  if (sizes.size() < 2 || std::any_of(values.begin(), values.end(), missing)) return {};
  const std::vector<Sample> samples = ascending(sizes, values);
  const Sample* s = samples.data();
  const double finest = extrapolated(s, 1);
  if (samples.size() == 2) return {finest, std::abs(finest - s[0].value), not_measured};
  const Polynomial line = fitted(samples, 1), parabola = fitted(samples, 2);
  if (samples.size() > 3 && parabola.spread > line.spread / clearly_better)
    return {line.at_zero, 2 * line.standard_error, not_measured};
  const double value = parabola.at_zero;
  ContinuumLimit limit{value, std::max(2 * parabola.standard_error, std::abs(value - line.at_zero)),
                       order_of(s)};
  if (samples.size() > 3) return limit;
  limit.error = std::max(limit.error, std::abs(value - finest));
  if (limit.order >= 0.5 && limit.order <= 3)
    limit.error = std::max(limit.error, std::abs(value - extrapolated(s, limit.order)));
  return limit;
}

}  // namespace sinew
