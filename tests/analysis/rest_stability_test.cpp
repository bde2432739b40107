// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/analysis/rest_stability.h>

#include <gtest/gtest.h>
#include <cmath>

namespace sinew::rest_stability_test {

/// Eq. 1 with k = 1 N/m.
PairForce law(double lambda, double b, double r = 0.01) {
  PairForce pair;
  pair.r = r, pair.a = 2 * r, pair.b = b * r;
  pair.k1 = 1 / (4 * r);
  pair.k2 = lambda / (pair.b - pair.a);
  return pair;
}

const double literal = 2 * std::sqrt(2.0);

TEST(BainPath, RisesFirstWhereSecondNeighborsDoNotPull) {
  for (const double lambda : {0.05, 1.0})
    for (const double b : {2.2, 2.6, 2.75}) EXPECT_GT(bain_path(law(lambda, b)).barrier(), 2e-5);
}

TEST(BainPath, FallsFromTheStartWithTheLiteralRangeTheMoreTheLargerLambda) {
  double before = 0;
  for (const double lambda : {0.02, 0.05, 0.2, 1.0}) {
    const BainPath path = bain_path(law(lambda, literal));
    EXPECT_LT(path.barrier(), 0.02 * path.fall()) << lambda;
    EXPECT_GT(path.fall(), 1.5 * before) << lambda;
    before = path.fall();
  }
}

/// Six neighbors come from 2 sqrt(2) r into the range, four leave it: with contacts that are stiff
/// beside the attraction, BCC has its 8 neighbors at 2 r and 6 at 4 r / sqrt(3).
TEST(BainPath, EndsWithTheEnergyOfTheBonds) {
  const PairForce pair = law(1e-4, literal);
  const double k_r2 = pair.contact_stiffness() * pair.r * pair.r;
  const double fcc = 6 * pair.potential(2 * pair.r);  // half of 12
  const double bcc =
      4 * pair.potential(2 * pair.r) + 3 * pair.potential(4 / std::sqrt(3.0) * pair.r);
  EXPECT_NEAR(bain_path(pair).fall(), (fcc - bcc) / k_r2, 2e-3 * (fcc - bcc) / k_r2);
}

TEST(BainPath, IsTheSameForAnySize) {
  const BainPath one = bain_path(law(1, literal)), other = bain_path(law(1, literal, 1e-3));
  for (std::size_t n = 0; n < one.energy.size(); ++n)
    EXPECT_NEAR(one.energy[n], other.energy[n], 1e-9);
}

}  // namespace sinew::rest_stability_test
