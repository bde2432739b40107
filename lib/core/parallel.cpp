// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/parallel.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <vector>

namespace sinew {

void with_threads(int threads, const std::function<void()>& job) {
  const int count = threads > 0 ? threads : tbb::this_task_arena::max_concurrency();
  // Both are needed: the control alone gives no more threads than cores, the arena alone no
  // workers.
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, count);
  tbb::task_arena(count).execute(job);
}

void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t)>& body) {
  const std::size_t pieces = (count + grain - 1) / grain;
  if (pieces <= 1) {
    if (count > 0) body(0, count);
    return;
  }
  tbb::parallel_for(std::size_t{0}, pieces, [&](std::size_t piece) {
    body(piece * grain, std::min(count, (piece + 1) * grain));
  });
}

void parallel_split(std::size_t count, std::size_t least,
                    const std::function<void(std::size_t, std::size_t)>& body) {
  const auto threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  const std::size_t parts = std::min(threads, count / std::max<std::size_t>(least, 1));
  if (parts <= 1) {
    if (count > 0) body(0, count);
    return;
  }
  tbb::parallel_for(
      std::size_t{0}, parts,
      [&](std::size_t part) { body(part * count / parts, (part + 1) * count / parts); },
      tbb::static_partitioner());
}

double parallel_sum(std::size_t count, std::size_t grain,
                    const std::function<double(std::size_t, std::size_t)>& piece) {
  std::vector<double> sums((count + grain - 1) / grain);
  parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
    sums[begin / grain] = piece(begin, end);
  });
  double sum = 0;  // in the order of the pieces, whichever thread made them
  for (const double part : sums) sum += part;
  return sum;
}

}  // namespace sinew
