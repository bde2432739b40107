// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/value_range.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include <sinew/core/error.h>

namespace sinew {
namespace {

constexpr int dropped = 12;  // bits of a float that do not tell bins apart
constexpr std::uint32_t sign = 0x80000000;

/// Whole numbers in the order of the values.
std::uint32_t ordered(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  return (bits & sign) != 0 ? ~bits : bits | sign;
}

float value_of(std::uint32_t order) {
  return std::bit_cast<float>((order & sign) != 0 ? order & ~sign : ~order);
}

}  // namespace

ValueRange color_range(std::span<const double> numbers) {
  if (numbers.size() != 2 || !(numbers[0] < numbers[1]))
    throw bad_input("a range of colors needs two numbers, the lower one first",
                    "give it as --range 0,0.5");
  return {numbers[0], numbers[1]};
}

std::string quantity_of(const std::string& array) { return array == "velocity" ? "speed" : array; }

void RangeFinder::add(float value) {
  if (!std::isfinite(value)) return;
  constexpr std::size_t pages = std::size_t{1} << (32 - dropped - 8);
  if (pages_.empty()) pages_.resize(pages);
  const std::uint32_t bin = ordered(value) >> dropped;
  auto& page = pages_[bin >> 8];
  if (!page) page = std::make_unique<Page>(Page{});
  ++(*page)[bin & 255];
  ++count_;
  min_ = std::min(min_, value);
  max_ = std::max(max_, value);
}

void RangeFinder::add(std::span<const double> values) {
  for (const double value : values) add(static_cast<float>(value));
}

void RangeFinder::add(std::span<const float> values) {
  for (const float value : values) add(value);
}

/// The middle of the bin in which that value lies, by size.
double RangeFinder::at_rank(std::uint64_t rank) const {
  std::uint64_t before = 0;
  for (std::uint32_t page = 0; page < pages_.size(); ++page) {
    if (!pages_[page]) continue;
    for (std::uint32_t k = 0; k < 256; ++k) {
      before += (*pages_[page])[k];
      if (before <= rank) continue;
      const float middle = value_of(((page << 8 | k) << dropped) | (1u << (dropped - 1)));
      return std::abs(middle) < std::numeric_limits<float>::min() ? 0
                                                                  : std::clamp(middle, min_, max_);
    }
  }
  return max_;
}

ValueRange RangeFinder::range() const {
  if (count_ == 0) return {};
  const auto outside = static_cast<std::uint64_t>(beyond_range * static_cast<double>(count_));
  const double low = at_rank(outside), high = at_rank(count_ - 1 - outside);
  return {min_ >= 0 && low < high / 2 ? 0 : low, high};
}

}  // namespace sinew
