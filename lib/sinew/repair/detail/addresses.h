// SPDX-License-Identifier: GPL-3.0-or-later
// An allocator for algorithms of CGAL whose results depend on where their parts lie.
//
//     #define CGAL_ALLOCATOR(T) sinew::Ascending<T>   // before CGAL's containers are included
//     const Addresses ascending;                      // around the work
#pragma once

#include <cstddef>
#include <memory>
#include <new>

namespace sinew {

/// CGAL's contraction and its surface mesher take the parts of a mesh by their addresses. From one
/// block, and never reused, these ascend in the order of allocation: the result does not depend on
/// what was freed before. A block lives as long as this object.
class Addresses {
 public:
  Addresses() : before_(current()) { current() = this; }
  ~Addresses() { current() = before_; }
  Addresses(const Addresses&) = delete;
  Addresses& operator=(const Addresses&) = delete;

  static Addresses*& current() {
    thread_local Addresses* now = nullptr;
    return now;
  }

  void* take(std::size_t bytes) {
    used_ = (used_ + alignof(std::max_align_t) - 1) / alignof(std::max_align_t) *
            alignof(std::max_align_t);
    if (used_ + bytes > size) throw std::bad_alloc();
    used_ += bytes;
    return block_.get() + (used_ - bytes);
  }

 private:
  static constexpr std::size_t size = std::size_t{256} << 20;  // touched as far as it is used

  std::unique_ptr<std::byte[]> block_{new std::byte[size]};
  std::size_t used_ = 0;
  Addresses* before_;
};

template <class T>
struct Ascending {
  using value_type = T;
  Ascending() = default;
  template <class U>
  Ascending(const Ascending<U>&) {}
  T* allocate(std::size_t count) {
    return static_cast<T*>(Addresses::current()->take(count * sizeof(T)));
  }
  void deallocate(T*, std::size_t) {}
  bool operator==(const Ascending&) const { return true; }
};

}  // namespace sinew
