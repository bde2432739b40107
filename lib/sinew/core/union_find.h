// SPDX-License-Identifier: GPL-3.0-or-later
// Disjoint sets of the numbers 0 to n - 1, for connected components.
//
//     UnionFind groups(n);
//     groups.join(a, b);
#pragma once

#include <cstddef>
#include <numeric>
#include <vector>

namespace sinew {

class UnionFind {
 public:
  explicit UnionFind(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  /// The lowest number of the set of `i`.
  int first_of(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  void join(int a, int b) {
    a = first_of(a);
    b = first_of(b);
    a < b ? parent_[b] = a : parent_[a] = b;
  }

 private:
  std::vector<int> parent_;
};

}  // namespace sinew
