// SPDX-License-Identifier: GPL-3.0-or-later
// Parallel loops whose results do not depend on the number of threads: the split of the work
// depends on its size alone, and sums are added in the order of the pieces.
//
//     parallel_for(points.size(), 4096, [&](std::size_t begin, std::size_t end) { ... });
#pragma once

#include <cstddef>
#include <functional>

namespace sinew {

/// Runs `job` with at most `threads` threads (0: one per core) for its parallel loops.
void with_threads(int threads, const std::function<void()>& job);

/// Calls body(begin, end) for pieces of [0, count) of `grain` items; a single one in the caller.
void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t)>& body);

/// Calls body(begin, end) for as many equal parts of [0, count) as there are threads, none smaller
/// than `least`: for work whose result does not depend on the split.
void parallel_split(std::size_t count, std::size_t least,
                    const std::function<void(std::size_t, std::size_t)>& body);

/// The sum of piece(begin, end) over pieces of `grain` items, added in the order of the pieces.
double parallel_sum(std::size_t count, std::size_t grain,
                    const std::function<double(std::size_t, std::size_t)>& piece);

}  // namespace sinew
