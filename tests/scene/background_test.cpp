// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/run/background.h>

#include <gtest/gtest.h>
#include <atomic>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <vector>

#include <sinew/core/error.h>

namespace sinew::background_test {

void pause() { std::this_thread::sleep_for(std::chrono::milliseconds(2)); }

Background::Job failing() {
  return [] { throw not_written("f.vtu", "cannot be written", "free some space"); };
}

TEST(Background, DoesAllJobsInTheirOrder) {
  std::vector<int> done, expected;
  Background background(2);
  for (int i = 0; i < 100; ++i) {
    background.hand([&, i] { return [&, i] { done.push_back(i); }; });
    expected.push_back(i);
  }
  background.finish();
  EXPECT_EQ(done, expected);
}

TEST(Background, WorksBesideItsCaller) {
  std::thread::id worker;
  Background background(2);
  background.hand([&] { return [&] { worker = std::this_thread::get_id(); }; });
  background.finish();
  EXPECT_NE(worker, std::thread::id());
  EXPECT_NE(worker, std::this_thread::get_id());
}

TEST(Background, HoldsNoMoreThanItMay) {
  std::atomic<int> alive = 0, most = 0;
  {
    Background background(2);
    for (int i = 0; i < 50; ++i)
      background.hand([&] {
        const std::shared_ptr<int> load(new int(++alive), [&](const int* p) { --alive, delete p; });
        most = std::max(most.load(), alive.load());
        return [load] { pause(); };
      });
  }
  EXPECT_LE(most, 2);
  EXPECT_EQ(alive, 0);
}

TEST(Background, ThrowsWhatAJobHasThrownAtTheNextCallAndAtEveryLater) {
  Background background(2);
  background.hand(failing);
  for (int call = 0; call < 3; ++call) {
    try {
      background.finish();
      FAIL() << "nothing was thrown";
    } catch (const Error& error) {
      EXPECT_EQ(error.exit(), Exit::not_written);
      EXPECT_STREQ(error.what(), "f.vtu: cannot be written; free some space");
    }
    EXPECT_THROW(background.hand(failing), Error);
  }
}

TEST(Background, DropsWhatFollowsAJobThatThrew) {
  std::atomic<bool> go = false, followed = false;
  {
    Background background(3);
    background.hand([&] {
      return [&] {
        while (!go) pause();
        throw std::runtime_error("first");
      };
    });
    for (int i = 0; i < 2; ++i) background.hand([&] { return [&] { followed = true; }; });
    go = true;
    EXPECT_THROW(background.finish(), std::runtime_error);
  }
  EXPECT_FALSE(followed);
}

TEST(Background, FinishesWhatItHasWhenItIsOnlyDropped) {
  int done = 0;
  {
    Background background(2);
    for (int i = 0; i < 5; ++i) background.hand([&] { return [&] { pause(), ++done; }; });
  }
  EXPECT_EQ(done, 5);
}

TEST(Background, IsDroppedInSilenceAfterAFailure) {
  Background background(2);
  background.hand(failing);
}

TEST(Background, AFailedHandOverLeavesItUsable) {
  int done = 0;
  Background background(1);
  EXPECT_THROW(background.hand([]() -> Background::Job { throw std::bad_alloc(); }),
               std::bad_alloc);
  background.hand([&] { return [&] { ++done; }; });
  background.finish();
  EXPECT_EQ(done, 1);
}

}  // namespace sinew::background_test
