// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include <sinew/rig/figure/figure.h>
#include <sinew/rig/rest_at.h>

namespace sinew {
namespace {

constexpr double times_better = 1.4;  // times as open, for the file's rest pose to be left
constexpr double nearly_best = 0.95;  // fraction of the best
constexpr int poses_tried = 120;
constexpr double far_turn = 120 * pi / 180;  // turn of a joint from rest, rad: no body turns so far

Vec3 tail_of(const Skeleton& skeleton, int bone) { return skeleton.bones[bone].tail(); }

/// The fraction of their thickness that limbs have room for, by their lengths.
double room_in(const Skeleton& posed, const Anatomy& anatomy) {
  double thickness = 0, wanted = 0;
  const std::vector<FigurePart> usual = parts_of(posed, anatomy), made = figure_of(posed, anatomy);
  for (std::size_t i = 0; i < made.size(); ++i) {
    const double length = (made[i].to - made[i].from).norm();
    thickness += length * made[i].radius, wanted += length * usual[i].radius;
  }
  return wanted > 0 ? thickness / wanted : 0;
}

/// The mean of their straight length over that along the bones.
double straightness(const Skeleton& posed, const Anatomy& anatomy) {
  double sum = 0;
  for (const LimbPair& pair : anatomy.pairs)
    for (std::size_t side = 0; side < 2; ++side) {
      const Vec3 from = posed.bones[pair.first[side]].head();
      sum += (tail_of(posed, pair.tip[side]) - from).norm() / pair.length[side];
    }
  return std::min(1.0, sum / 4);
}

double uprightness(const Skeleton& posed, const Anatomy& anatomy, const Vec3& up) {
  const LimbPair& legs = anatomy.legs();
  const Vec3 feet = (tail_of(posed, legs.tip[0]) + tail_of(posed, legs.tip[1])) / 2;
  const int top = anatomy.head.empty() ? anatomy.trunk.back() : anatomy.head.back();
  return std::clamp((tail_of(posed, top) - feet).dot(up) / anatomy.height, 0.0, 1.0);
}

/// Whether a bone that only carries the figure lies in it.
bool carrier_lies_in(const Skeleton& skeleton, const Anatomy& anatomy) {
  int top = anatomy.trunk.front();
  for (const int b : anatomy.trunk) top = std::min(top, b);
  const int carrier = skeleton.bones[top].parent;
  return carrier != no_bone &&
         (skeleton.bones[top].head() - skeleton.bones[carrier].head()).norm() <
             0.02 * anatomy.height;
}

/// Whether some joint is never near its rest, as where bones were not measured as they move.
bool is_always_far_from_rest(const Skeleton& skeleton, Motion clip,
                             const std::vector<double>& times) {
  clip.preroll = 0;
  std::vector<double> least(skeleton.size(), pi);
  for (const double time : times) {
    clip.start = time;
    const std::vector<LocalMotion> locals = local_motions(skeleton, clip, 0);
    for (std::size_t b = 0; b < locals.size(); ++b)
      least[b] = std::min(least[b], locals[b].rotation.angularDistance(Quat::Identity()));
  }
  for (std::size_t b = 0; b < least.size(); ++b)
    if (skeleton.bones[b].parent != no_bone && least[b] > far_turn) return true;
  return false;
}

}  // namespace

double openness(const Skeleton& posed, const Anatomy& anatomy, const Vec3& up) {
  const double upright = uprightness(posed, anatomy, up);
  return upright > 0 ? room_in(posed, anatomy) * straightness(posed, anatomy) * upright : 0;
}

std::optional<double> best_pose(const Rig& rig, const Anatomy& anatomy, const Vec3& up) {
  if (rig.clips.empty()) return std::nullopt;
  const Motion& clip = rig.clips.front().motion;
  const std::vector<double> times = times_in(clip, poses_tried);
  if (!anatomy.is_figure() && !is_always_far_from_rest(rig.skeleton, clip, times))
    return std::nullopt;
  const auto how_open = [&](const Skeleton& posed) {
    return anatomy.is_figure() ? openness(posed, anatomy, up) : room_in(posed, anatomy);
  };
  Rig one;  // without its clips, which need not turn with it
  one.skeleton = rig.skeleton;
  std::vector<double> open;
  open.reserve(times.size());
  for (const double time : times) open.push_back(how_open(with_rest_at(one, clip, time).skeleton));
  const double best = *std::max_element(open.begin(), open.end());
  const bool better = best >= times_better * how_open(rig.skeleton);
  if (best <= 0 || (anatomy.is_figure() && !better && !carrier_lies_in(rig.skeleton, anatomy)))
    return std::nullopt;
  const auto first = std::find_if(open.begin(), open.end(),
                                  [&](double value) { return value >= nearly_best * best; });
  return times[static_cast<std::size_t>(first - open.begin())];
}

}  // namespace sinew
