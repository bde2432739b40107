// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/slices.h>

#include <cmath>
#include <map>

#include <sinew/core/decompositions.h>
#include <sinew/core/deformation.h>
#include <sinew/core/particles.h>

namespace sinew {
namespace {

constexpr double same_direction = 1e-6;  // sine of the angle up to which axes count as parallel
constexpr double same_line = 1e-3;  // largest offset of heads from the line, over the bone's length
constexpr double in_a_line = 1e-6;  // ratio of spreads below which a slice has no rotation
constexpr std::size_t fewest_of_slice = 4;  // particles of a slice

using Members = std::vector<std::uint32_t>;

bool continues(const Bone& bone, const Bone& first) {
  const Vec3 offset = bone.rest.origin - first.rest.origin;
  return bone.axis().dot(first.axis()) > 0 &&
         bone.axis().cross(first.axis()).norm() < same_direction &&
         offset.cross(first.axis()).norm() < same_line * bone.length;
}

/// The first bone of each bone's straight chain.
std::vector<int> chain_starts(std::span<const Bone> bones) {
  std::vector<int> starts;
  for (std::size_t i = 0; i < bones.size(); ++i) {
    const int parent = bones[i].parent;
    const bool goes_on = parent >= 0 && continues(bones[i], bones[starts[parent]]);
    starts.push_back(goes_on ? starts[parent] : static_cast<int>(i));
  }
  return starts;
}

double along(const Bone& bone, const Vec3& point) {
  return bone.axis().dot(point - bone.rest.origin);
}

Vec3 center_of(const Members& members, const Points& points) {
  Vec3 sum = Vec3::Zero();
  for (const auto i : members) sum += points[i];
  return sum / static_cast<double>(members.size());
}

bool has_turn(const Members& members, const Points& rest) {
  if (members.size() < fewest_of_slice) return false;
  const Vec3 center = center_of(members, rest);
  Mat3 spread = Mat3::Zero();
  for (const auto i : members) spread += (rest[i] - center) * (rest[i] - center).transpose();
  const Vec3 extents = eigenvalues(spread);
  return extents[1] > in_a_line * extents[2];
}

/// The chain's slices by their number, counted from its outermost particle.
std::map<double, Members> cut(const Members& members, const Points& rest, const Bone& first,
                              double thickness) {
  double start = std::numeric_limits<double>::infinity();
  for (const auto i : members) start = std::min(start, along(first, rest[i]));
  std::map<double, Members> slices;
  for (const auto i : members)
    slices[std::floor((along(first, rest[i]) - start) / thickness + 0.5)].push_back(i);
  return slices;
}

void add_chain(Slices& slices, const Members& members, const Points& rest, const Bone& first,
               double thickness) {
  double last = -2;
  for (auto& [number, particles] : cut(members, rest, first, thickness)) {
    if (!has_turn(particles, rest)) continue;
    const int index = static_cast<int>(slices.all.size());
    if (number == last + 1) slices.neighbors.push_back({index - 1, index});
    last = number;
    slices.all.push_back({std::move(particles), first.axis()});
  }
}

/// The two outermost half-planes; the cut is midway between the second and the third.
Slice tip_of(const Members& members, const Points& rest, const Bone& bone, double thickness) {
  double end = -std::numeric_limits<double>::infinity();
  for (const auto i : members) end = std::max(end, along(bone, rest[i]));
  Slice tip{{}, bone.axis()};
  for (const auto i : members)
    if (along(bone, rest[i]) > end - 1.5 * thickness) tip.particles.push_back(i);
  if (!has_turn(tip.particles, rest)) tip.particles.clear();
  return tip;
}

Members followers(std::span<const int> bone, const std::vector<int>& starts, int start) {
  Members members;
  for (std::size_t i = 0; i < bone.size(); ++i)
    if (bone[i] >= 0 && starts[bone[i]] == start) members.push_back(static_cast<std::uint32_t>(i));
  return members;
}

double angle_of(const Mat3& rotation) { return Eigen::AngleAxisd(Quat(rotation)).angle(); }

}  // namespace

Slices make_slices(const Points& rest, std::span<const int> bone, std::span<const Bone> bones,
                   double radius) {
  Slices slices;
  if (bones.empty()) return slices;
  const double thickness = half_plane_spacing(radius);
  const std::vector<int> starts = chain_starts(bones);
  for (int i = 0; i < static_cast<int>(bones.size()); ++i)
    if (starts[i] == i) add_chain(slices, followers(bone, starts, i), rest, bones[i], thickness);
  Members last;
  for (std::size_t i = 0; i < bone.size(); ++i)
    if (bone[i] + 1 == static_cast<int>(bones.size()))
      last.push_back(static_cast<std::uint32_t>(i));
  slices.tip = tip_of(last, rest, bones.back(), thickness);
  return slices;
}

Mat3 turn_of(const Slice& slice, const Points& rest, const Points& now) {
  const Vec3 from = center_of(slice.particles, rest), to = center_of(slice.particles, now);
  Mat3 moved = Mat3::Zero();
  for (const auto i : slice.particles) moved += (now[i] - to) * (rest[i] - from).transpose();
  return rotation_part(moved);
}

double tip_turn(const Slices& slices, const Points& rest, const Points& now) {
  if (slices.tip.particles.empty()) return not_measured;
  return angle_of(turn_of(slices.tip, rest, now));
}

double largest_twist_jump(const Slices& slices, const Points& rest, const Points& now) {
  std::vector<Mat3> turns(slices.all.size());
  parallel_for(turns.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) turns[i] = turn_of(slices.all[i], rest, now);
  });
  Statistics jumps;
  for (const auto& [one, next] : slices.neighbors) {
    const Vec3 axis = (turns[one] + turns[next]) * slices.all[one].axis;
    const Quat relative(Mat3(turns[next] * turns[one].transpose()));
    const double about = axis.norm() > 0 ? relative.vec().dot(axis.normalized()) : 0;
    jumps.add(2 * std::atan2(std::abs(about), std::abs(relative.w())));
  }
  return jumps.max();
}

}  // namespace sinew
