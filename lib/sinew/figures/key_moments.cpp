// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/figures/key_moments.h>

#include <algorithm>
#include <cmath>

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

std::size_t index_of_largest(const std::vector<double>& values) {
  return static_cast<std::size_t>(std::max_element(values.begin(), values.end()) - values.begin());
}

double largest_turn(const RunOverview& overview) {
  return *std::max_element(overview.angle.begin(), overview.angle.end());
}

/// At most thirty bytes of a name, of whole letters.
std::string shortened(std::string name) {
  constexpr std::size_t most = 30;
  if (name.size() <= most) return name;
  std::size_t end = most - 3;
  while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xC0) == 0x80) --end;
  return name.substr(0, end) + "...";
}

/// Two digits are as many as anybody compares.
std::string radii_text(double radii) {
  const double step = std::pow(10, std::floor(std::log10(radii)) - 1);
  return three_digits(std::round(radii / step) * step) + " r";
}

}  // namespace

std::string return_in_words(const RunOverview& overview, double radius) {
  const double most = largest_turn(overview);
  if (most < min_turn || overview.angle.back() > returned_turn * most) return "";
  const double off = overview.shift.back() / radius, farthest = overview.farthest.back() / radius;
  if (farthest < near_rest) return "returned";
  return "returned, " + radii_text(std::max(off, near_rest / 10)) + " off in the mean, " +
         radii_text(farthest) + " at most";
}

std::vector<KeyMoment> key_moments(const RunOverview& overview, double radius) {
  const std::vector<double>& angle = overview.angle;
  const double most = largest_turn(overview);
  const std::size_t last = angle.size() - 1;
  std::vector<KeyMoment> moments;
  if (most < min_turn)
    for (const std::size_t frame : spread_over(angle.size())) moments.push_back({frame, ""});
  else {
    std::size_t half = 0, farthest = 0;
    while (angle[half] < most / 2) ++half;
    for (std::size_t i = 0; i < angle.size(); ++i)
      if (angle[i] >= most * (1 - 1e-5)) farthest = i;
    std::string what =
        "largest turn" + (overview.turned.empty() ? "" : ", of " + shortened(overview.turned));
    if (half == 0 && !overview.from_start.empty())  // it begins posed, as clips in a loop do
      farthest = index_of_largest(overview.from_start), what = "farthest from the start";
    moments = {{0, ""}, {half, "half way"}, {farthest, what}};
    const std::string returned = return_in_words(overview, radius);
    if (last != farthest) moments.push_back({last, returned.empty() ? "the end" : returned});
    std::stable_sort(moments.begin(), moments.end(),
                     [](const KeyMoment& a, const KeyMoment& b) { return a.frame < b.frame; });
    const auto same = [](const KeyMoment& a, const KeyMoment& b) { return a.frame == b.frame; };
    moments.erase(std::unique(moments.begin(), moments.end(), same), moments.end());
  }
  if (overview.shift.front() < near_rest * radius) moments.front().what = "at rest";
  return moments;
}

Turned largest_turn(const RunFiles& run, const FrameState& frame) {
  Turned most;
  for (std::size_t b = 0; b < frame.bones.size(); ++b) {
    const Mat3 turn = frame.bones[b].rotation * run.skeleton.bones[b].rest.rotation.transpose();
    if (const double angle = Eigen::AngleAxisd(turn).angle(); angle > most.angle) most = {angle, b};
  }
  return most;
}

}  // namespace sinew
