// SPDX-License-Identifier: GPL-3.0-or-later
// Arrays of lines of the cache: where they begin, and that they hold and give back what others do.
#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>
#include <set>
#include <vector>

#include <sinew/core/lines.h>

namespace sinew::lines_test {

template <class T>
std::uintptr_t place_of(const Lines<T>& array) {
  return reinterpret_cast<std::uintptr_t>(array.data());
}

TEST(Lines, BeginAtALineWhateverTheirSize) {
  for (const std::size_t size : {1, 3, 100, 16384, 16385, 1000000}) {
    EXPECT_EQ(place_of(Lines<float>(size)) % 64, 0U) << size;
    EXPECT_EQ(place_of(Lines<double>(size)) % 64, 0U) << size;
    EXPECT_EQ(place_of(Lines<char>(size)) % 64, 0U) << size;
  }
}

TEST(Lines, OfManyLargeArraysBeginAtDifferentOnesOfAPage) {
  std::vector<Lines<float>> arrays(24, Lines<float>(100000));
  std::set<std::uintptr_t> lines;
  for (const auto& array : arrays) lines.insert(place_of(array) % 4096);
  EXPECT_EQ(lines.size(), arrays.size());
}

TEST(Lines, KeepTheirValuesAsTheyGrowAndMove) {
  Lines<int> array;
  for (int k = 0; k < 200000; ++k) array.push_back(k);
  Lines<int> copy = array, moved = std::move(array);
  EXPECT_EQ(copy, moved);
  std::vector<int> expected(200000);
  std::iota(expected.begin(), expected.end(), 0);
  EXPECT_TRUE(std::equal(copy.begin(), copy.end(), expected.begin(), expected.end()));
}

TEST(Lines, OfMoreThanThereIsAreRefused) {
  LineAllocator<double> allocator;
  EXPECT_THROW(allocator.allocate(SIZE_MAX / 8), std::bad_alloc);
  EXPECT_THROW(allocator.allocate(SIZE_MAX / 32), std::bad_alloc);
}

}  // namespace sinew::lines_test
