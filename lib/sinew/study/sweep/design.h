// SPDX-License-Identifier: GPL-3.0-or-later
// Designs of experiments: which values of some varied quantities go together in each run.
//
//     for (const DesignPoint& sample : latin_hypercube(200, 5, 1)) use(sample[0]);
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sinew {

/// One place in the unit cube: a number in [0, 1) for each quantity.
using DesignPoint = std::vector<double>;

/// Each of the `samples` equal parts of [0, 1) holds one number of each quantity (McKay, Beckman
/// and Conover 1979, doi 10.1080/00401706.1979.10489755). The same on every machine.
std::vector<DesignPoint> latin_hypercube(std::size_t samples, std::size_t quantities,
                                         std::int64_t seed);

/// Sobol's sequence behind the origin, with the direction numbers of Joe and Kuo (2008),
/// shifted digit by digit as the seed asks; by 0: not at all. The same on every machine.
std::vector<DesignPoint> sobol(std::size_t samples, std::size_t quantities, std::int64_t seed);

/// Every combination of places in lists of these lengths, the last one fastest.
std::vector<std::vector<std::size_t>> grid(const std::vector<std::size_t>& lengths);

}  // namespace sinew
