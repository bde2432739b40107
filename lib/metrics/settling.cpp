// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/settling.h"

#include "metrics/measure.h"

namespace sinew {
namespace {

constexpr double still_turn = 0.01;  // degrees: below what a smooth motion turns in its first frame
constexpr double still_shift = 1e-3;      // radii
constexpr double settled_within = 0.2;    // radii
constexpr std::size_t fewest_frames = 3;  // with two there is nothing between start and end

bool still(const std::vector<RigidFrame>& from, const std::vector<RigidFrame>& to, double radius) {
  const PoseChange change = pose_change(from, to);
  return degrees(change.turn) <= still_turn && change.shift <= still_shift * radius;
}

double rms_distance(const Points& one, const Points& other) {
  return statistics(one.size(), [&](std::size_t i) { return (one[i] - other[i]).norm(); }).rms();
}

}  // namespace

std::vector<Hold> holds(std::span<const std::vector<RigidFrame>> bones, double radius) {
  std::vector<Hold> found;
  for (std::size_t first = 0; first < bones.size();) {
    std::size_t last = first;
    while (last + 1 < bones.size() && still(bones[first], bones[last + 1], radius)) ++last;
    if (last - first + 1 >= fewest_frames) found.push_back({first, last});
    first = last + 1;
  }
  return found;
}

double settling_time(const Hold& hold, std::span<const double> times, double radius,
                     const std::function<Points(std::size_t frame)>& positions) {
  const Points end = positions(hold.last);
  std::size_t settled = hold.last;
  while (settled > hold.first &&
         rms_distance(positions(settled - 1), end) < settled_within * radius)
    --settled;
  return times[settled] - times[hold.first];
}

}  // namespace sinew
