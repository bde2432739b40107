// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/run/background.h>

#include <utility>

#include <sinew/core/system.h>

namespace sinew {

Background::Background(std::size_t most) : most_(most), thread_([this] { work(); }) {}

Background::~Background() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
  }
  handed_.notify_one();
  thread_.join();
}

void Background::hand(const std::function<Job()>& make) {
  Stopwatch watch;
  {
    std::unique_lock lock(mutex_);
    wait_for_fewer(lock, most_);
  }
  waited_ += watch.lap();
  Job job = make();  // only this thread adds jobs: there is still room
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(std::move(job));
  }
  handed_.notify_one();
}

void Background::finish() {
  std::unique_lock lock(mutex_);
  wait_for_fewer(lock, 1);
}

void Background::wait_for_fewer(std::unique_lock<std::mutex>& lock, std::size_t most) {
  done_.wait(lock, [&] { return waiting_.size() + busy_ < most || (failure_ && !busy_); });
  if (failure_) std::rethrow_exception(failure_);
}

void Background::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    handed_.wait(lock, [&] { return closing_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    Job job = std::move(waiting_.front());
    waiting_.pop_front();
    busy_ = !failure_;
    if (busy_) {
      lock.unlock();
      std::exception_ptr failure;
      try {
        job();
      } catch (...) {
        failure = std::current_exception();
      }
      job = nullptr;  // frees its data before there is room for another
      lock.lock();
      busy_ = false;
      if (failure) failure_ = failure, waiting_.clear();
    }
    done_.notify_all();
  }
}

}  // namespace sinew
