// SPDX-License-Identifier: GPL-3.0-or-later
// Jobs done one after the other by a thread of their own, while the caller goes on.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace sinew {

/// Does jobs in the order in which they are handed over. After one that throws, those that wait are
/// dropped and no more are done: what they build upon is not there.
class Background {
 public:
  using Job = std::function<void()>;

  /// At most `most` (> 0) jobs are under way at a time, those that wait included.
  explicit Background(std::size_t most);
  /// Finishes what was handed over; what is thrown meanwhile is lost: call finish() to hear of it.
  ~Background();
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  /// Waits for room and hands over what make() returns; make() is called here, with the room at
  /// hand, so that what a job holds exists at most `most` times. Throws what a job before has
  /// thrown.
  void hand(const std::function<Job()>& make);
  /// Waits until all is done. Throws what a job has thrown, each time it is called.
  void finish();
  /// How long hand() has waited for room in all, s: what the jobs have held up the caller.
  double waited() const { return waited_; }

 private:
  void work();
  /// Waits, with the lock held, until fewer than `most` jobs are under way or one has failed.
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
