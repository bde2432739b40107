// SPDX-License-Identifier: GPL-3.0-or-later
// Jobs executed one after the other by a thread of their own, while the caller continues.
//
//     Background writer(2);
//     writer.hand([&] { return [frame = frame_now()] { write(frame); }; });
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace sinew {

/// Executes jobs in the order in which they are handed over. After one throws, those that wait are
/// dropped and no more are executed: later jobs build upon earlier ones.
class Background {
 public:
  using Job = std::function<void()>;

  /// At most `most` (> 0) jobs exist at a time, including those that wait.
  explicit Background(std::size_t most);
  /// Finishes all jobs; errors are lost: call finish() to get them.
  ~Background();
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  /// Waits for room and hands over what make() returns; make() is called here, after the wait, so
  /// that the data of at most `most` jobs exist. Throws what an earlier job has thrown.
  void hand(const std::function<Job()>& make);
  /// Waits until all jobs are done. Throws what a job has thrown, each time it is called.
  void finish();
  /// Total time hand() has waited for room, s: how long the jobs have delayed the caller.
  double waited() const { return waited_; }

 private:
  void work();
  /// Waits, owning the lock, until fewer than `most` jobs exist or one has failed.
  void wait_for_fewer(std::unique_lock<std::mutex>& lock, std::size_t most);

  std::size_t most_;
  double waited_ = 0;
  std::mutex mutex_;
  std::condition_variable handed_, done_;
  std::deque<Job> waiting_;
  bool busy_ = false, closing_ = false;
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace sinew
