// SPDX-License-Identifier: GPL-3.0-or-later
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <sinew/core/parallel.h>
#include <sinew/core/threads.h>

namespace sinew {

void with_threads(int threads, const std::function<void()>& job) {
  const int count = threads > 0 ? threads : tbb::this_task_arena::max_concurrency();
  // Both are needed: the control alone gives no more threads than cores, the arena no workers.
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, count);
  tbb::task_arena(count).execute(job);
}

int threads_allowed() { return tbb::this_task_arena::max_concurrency(); }

void run_pieces(std::size_t count, Deal deal, const std::function<void(std::size_t)>& piece) {
  if (deal == Deal::evenly)
    tbb::parallel_for(std::size_t{0}, count, piece, tbb::static_partitioner());
  else
    tbb::parallel_for(std::size_t{0}, count, piece);
}

}  // namespace sinew
