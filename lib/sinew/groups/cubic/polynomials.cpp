// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/groups/cubic/polynomials.h>

#include <algorithm>

namespace sinew {
namespace {

/// The term that is the product of these factors.
int term_of(std::array<int, 3> factors) {
  std::sort(factors.begin(), factors.end());
  const auto at = std::find(factors_of_terms.begin(), factors_of_terms.end(), factors);
  return static_cast<int>(at - factors_of_terms.begin());
}

}  // namespace

/// Adds up all parts of each product (x + d)(y + e)(z + f) but x y z.
Growth growth_over(const Vec3& difference) {
  Growth growth = Growth::Zero();
  for (int k = 0; k < cubic_terms; ++k) {
    const std::array<int, 3> factors = factors_of_terms[static_cast<std::size_t>(k)];
    for (unsigned taken = 1; taken < 8; ++taken) {
      std::array<int, 3> left = factors;
      double product = 1;
      for (std::size_t one = 0; one < 3; ++one) {
        if ((taken >> one & 1) == 0) continue;
        product *= factors[one] < 3 ? difference[factors[one]] : 0;
        left[one] = 3;
      }
      if (product != 0) growth(k, term_of(left)) += product;
    }
  }
  return growth;
}

}  // namespace sinew
