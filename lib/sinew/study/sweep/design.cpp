// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/study/sweep/design.h>

#include <boost/random/sobol.hpp>
#include <numeric>
#include <utility>

#include <sinew/core/random.h>

namespace sinew {

std::vector<DesignPoint> latin_hypercube(std::size_t samples, std::size_t quantities,
                                         std::int64_t seed) {
  Random random(seed);
  std::vector<DesignPoint> all(samples, DesignPoint(quantities));
  std::vector<std::size_t> part(samples);
  for (std::size_t q = 0; q < quantities; ++q) {
    std::iota(part.begin(), part.end(), std::size_t{0});
    for (std::size_t k = samples; k > 1; --k) std::swap(part[k - 1], part[random.next() % k]);
    for (std::size_t k = 0; k < samples; ++k)
      all[k][q] =
          (static_cast<double>(part[k]) + random.between(0, 1)) / static_cast<double>(samples);
  }
  return all;
}

std::vector<DesignPoint> sobol(std::size_t samples, std::size_t quantities, std::int64_t seed) {
  boost::random::sobol sequence(quantities);  // leaves out the origin
  Random random(seed);
  std::vector<std::uint64_t> shift(quantities, 0);
  if (seed != 0)
    for (std::uint64_t& digits : shift) digits = random.next();
  std::vector<DesignPoint> all(samples, DesignPoint(quantities));
  for (DesignPoint& sample : all)
    for (std::size_t q = 0; q < quantities; ++q)
      sample[q] = static_cast<double>((sequence() ^ shift[q]) >> 11) * 0x1p-53;
  return all;
}

std::vector<std::vector<std::size_t>> grid(const std::vector<std::size_t>& lengths) {
  std::vector<std::vector<std::size_t>> all(1);
  for (const std::size_t length : lengths) {
    std::vector<std::vector<std::size_t>> longer;
    longer.reserve(all.size() * length);
    for (const auto& places : all)
      for (std::size_t k = 0; k < length; ++k) {
        longer.push_back(places);
        longer.back().push_back(k);
      }
    all = std::move(longer);
  }
  return all;
}

}  // namespace sinew
