// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/parallel.h>

#include <gtest/gtest.h>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <vector>

namespace sinew::parallel_test {

constexpr int thread_counts[] = {1, 2, 3, 8};

TEST(ParallelFor, DoesEachItemOnceForEveryCountAndGrain) {
  for (const int threads : thread_counts)
    with_threads(threads, [] {
      for (const std::size_t count : {0, 1, 7, 64, 1000})
        for (const std::size_t grain : {1, 7, 64, 5000}) {
          std::vector<std::atomic<int>> done(count);
          parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
            EXPECT_LT(begin, end);
            EXPECT_LE(end - begin, grain);
            for (std::size_t i = begin; i < end; ++i) ++done[i];
          });
          for (const auto& times : done) ASSERT_EQ(times, 1);
        }
    });
}

TEST(ParallelSum, HasTheSameBitsForEveryThreadCount) {
  const std::size_t count = 100003;
  const auto piece = [](std::size_t begin, std::size_t end) {
    double sum = 0;  // terms of every size, so that another order gives other bits
    for (std::size_t i = begin; i < end; ++i)
      sum += std::exp(40 * std::sin(1.0 * i)) * (i % 2 - 0.5);
    return sum;
  };
  double in_order = 0;
  for (std::size_t begin = 0; begin < count; begin += 100)
    in_order += piece(begin, std::min(count, begin + 100));
  for (const int threads : thread_counts)
    for (int repeat = 0; repeat < 20; ++repeat)
      with_threads(threads, [&] { EXPECT_EQ(parallel_sum(count, 100, piece), in_order); });
}

TEST(ParallelSum, OfNothingIsZero) {
  EXPECT_EQ(parallel_sum(0, 10, [](std::size_t, std::size_t) { return 1.0; }), 0);
}

TEST(WithThreads, GivesAsManyThreadsAsAskedForBeyondTheCores) {
  for (const int threads : {2, 3, 8}) {
    std::mutex mutex;
    std::condition_variable all_here;
    int here = 0;
    with_threads(threads, [&] {
      // Each piece waits for all others: fewer threads would never finish.
      parallel_for(threads, 1, [&](std::size_t, std::size_t) {
        std::unique_lock lock(mutex);
        if (++here == threads) all_here.notify_all();
        all_here.wait(lock, [&] { return here == threads; });
      });
    });
  }
}

TEST(WithThreads, OfOneStaysInOneThread) {
  std::atomic<int> inside = 0, most = 0;
  with_threads(1, [&] {
    parallel_for(100, 1, [&](std::size_t, std::size_t) {
      const int now = ++inside;
      if (now > most) most = now;
      --inside;
    });
  });
  EXPECT_EQ(most, 1);
}

TEST(ParallelFor, HandsExceptionsToTheCaller) {
  const auto job = [] {
    parallel_for(1000, 10, [](std::size_t begin, std::size_t) {
      if (begin == 500) throw std::runtime_error("piece");
    });
  };
  EXPECT_THROW(with_threads(3, job), std::runtime_error);
}

}  // namespace sinew::parallel_test
