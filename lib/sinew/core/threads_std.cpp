// SPDX-License-Identifier: GPL-3.0-or-later
// Threads that exist for one loop: slow, but a sanitizer can follow them.
#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include <sinew/core/parallel.h>
#include <sinew/core/threads.h>

namespace sinew {
namespace {

thread_local int allowed = 0;  // 0: one per core

/// What the threads of one loop share.
class Pieces {
 public:
  Pieces(std::size_t count, const std::function<void(std::size_t)>& piece)
      : count_(count), piece_(piece) {}

  void work() {
    for (std::size_t i = next_++; i < count_; i = next_++) {
      try {
        piece_(i);
      } catch (...) {
        const std::lock_guard lock(failing_);
        if (!failure_) failure_ = std::current_exception();
        next_ = count_;
      }
    }
  }

  void report() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  std::size_t count_;
  const std::function<void(std::size_t)>& piece_;
  std::atomic<std::size_t> next_ = 0;
  std::mutex failing_;
  std::exception_ptr failure_;
};

/// Sets how many threads this thread may use, temporarily.
class Allowance {
 public:
  explicit Allowance(int threads) : before_(std::exchange(allowed, threads)) {}
  ~Allowance() { allowed = before_; }
  Allowance(const Allowance&) = delete;
  Allowance& operator=(const Allowance&) = delete;

 private:
  int before_;
};

}  // namespace

void with_threads(int threads, const std::function<void()>& job) {
  const Allowance allowance(threads > 0 ? threads : threads_allowed());
  job();
}

int threads_allowed() {
  return allowed > 0 ? allowed : std::max(1, int(std::thread::hardware_concurrency()));
}

void run_pieces(std::size_t count, Deal, const std::function<void(std::size_t)>& piece) {
  Pieces pieces(count, piece);
  const std::size_t helpers = std::min(count, std::size_t(threads_allowed())) - 1;
  const Allowance loops_within_run_alone(1);
  std::vector<std::jthread> threads;
  for (std::size_t t = 0; t < helpers; ++t)
    threads.emplace_back([&pieces] {
      const Allowance loops_within_run_alone_here_too(1);
      pieces.work();
    });
  pieces.work();
  threads.clear();  // joins them
  pieces.report();
}

}  // namespace sinew
