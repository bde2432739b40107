// SPDX-License-Identifier: GPL-3.0-or-later
// Arrays for loops over vector registers: they begin at a line of the cache, so that no block of 64
// bytes lies across two; and large ones, each at another line of a page, so that the same places of
// many arrays do not push each other out of the cache.
//
//     Lines<float> x(n);
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <vector>

namespace sinew {

template <class T>
struct LineAllocator {
  using value_type = T;
  static constexpr std::size_t line = 64, page = 4096, large = 16 * page;

  LineAllocator() = default;
  template <class U>
  LineAllocator(const LineAllocator<U>&) {}  // NOLINT(google-explicit-constructor)

  T* allocate(std::size_t n) {
    if (n > SIZE_MAX / 2 / sizeof(T)) throw std::bad_alloc();
    const bool pages = is_large(n);
    const std::size_t unit = pages ? page : line;
    const std::size_t bytes = (n * sizeof(T) + unit - 1) / unit * unit + (pages ? page : 0);
    auto* place = static_cast<char*>(std::aligned_alloc(unit, bytes));
    if (place == nullptr) throw std::bad_alloc();
    return reinterpret_cast<T*>(place + (pages ? next_line() : 0));
  }
  void deallocate(T* at, std::size_t n) {
    auto* place = reinterpret_cast<char*>(at);
    std::free(is_large(n) ? place - reinterpret_cast<std::uintptr_t>(place) % page : place);
  }

  template <class U>
  bool operator==(const LineAllocator<U>&) const {
    return true;
  }

 private:
  static bool is_large(std::size_t n) { return n * sizeof(T) >= large; }
  /// Picks a line of a page, another one for each array.
  static std::size_t next_line() {
    static std::atomic<std::size_t> count{0};
    constexpr std::size_t apart = 5;
    return apart * line * count.fetch_add(1, std::memory_order_relaxed) % page;
  }
};

template <class T>
using Lines = std::vector<T, LineAllocator<T>>;

}  // namespace sinew
