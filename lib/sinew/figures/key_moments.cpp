// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/figures/key_moments.h>

#include <algorithm>

#include <sinew/core/text.h>
#include <sinew/figures/snapshots.h>

namespace sinew {
namespace {

constexpr double min_turn = 0.01;       // rad: below it the bones do not move
constexpr double returned_turn = 0.02;  // fraction of the largest: the bones are back
constexpr double near_rest = 1e-3;      // radii: nothing has moved
constexpr std::size_t moments_without_turn = 5;

/// Evenly over all frames, including the first and the last.
std::vector<std::size_t> spread_over(std::size_t frames) {
  const std::size_t count = std::min(frames, moments_without_turn);
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < count; ++k)
    chosen.push_back(count == 1 ? 0 : k * (frames - 1) / (count - 1));
  return chosen;
}

std::string end_of(const RunOverview& overview, double radius, double most) {
  const double off = overview.shift.back() / radius;
  if (overview.angle.back() > returned_turn * most) return "the end";
  return off < near_rest ? "returned" : "returned, " + three_digits(off) + " r off";
}

}  // namespace

std::vector<KeyMoment> key_moments(const RunOverview& overview, double radius) {
  const std::vector<double>& angle = overview.angle;
  const double most = *std::max_element(angle.begin(), angle.end());
  const std::size_t last = angle.size() - 1;
  std::vector<KeyMoment> moments;
  if (most < min_turn)
    for (const std::size_t frame : spread_over(angle.size())) moments.push_back({frame, ""});
  else {
    std::size_t half = 0, farthest = 0;
    while (angle[half] < most / 2) ++half;
    for (std::size_t i = 0; i < angle.size(); ++i)
      if (angle[i] >= most * (1 - 1e-5)) farthest = i;
    moments = {{0, ""}, {half, "half way"}, {farthest, "largest turn"}};
    if (last != farthest) moments.push_back({last, end_of(overview, radius, most)});
    std::stable_sort(moments.begin(), moments.end(),
                     [](const KeyMoment& a, const KeyMoment& b) { return a.frame < b.frame; });
    const auto same = [](const KeyMoment& a, const KeyMoment& b) { return a.frame == b.frame; };
    moments.erase(std::unique(moments.begin(), moments.end(), same), moments.end());
  }
  if (overview.shift.front() < near_rest * radius) moments.front().what = "at rest";
  return moments;
}

}  // namespace sinew
