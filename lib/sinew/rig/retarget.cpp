// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/rig/retarget.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <sinew/core/error.h>
#include <sinew/core/text.h>

namespace sinew {
namespace {

constexpr double slowest = 1.0 / 30;    // s between samples
constexpr double far_from_rest = 0.25;  // fraction of the skeleton's size
constexpr double told = 20;             // degrees between rest poses that a warning tells
constexpr double same_time = 1e-9;      // s

int find(const Skeleton& skeleton, const std::string& name) {
  for (std::size_t b = 0; b < skeleton.size(); ++b)
    if (skeleton.bones[b].name == name) return static_cast<int>(b);
  return no_bone;
}

/// The bone of `from` for each of `to`, no_bone for none.
std::vector<int> sources_of(const Skeleton& to, const Skeleton& from,
                            const std::vector<NamePair>& names) {
  std::vector<int> sources(to.size(), no_bone);
  for (const auto& [own, given] : names) {
    const int bone = find(to, own), source = find(from, given);
    if (bone == no_bone || source == no_bone)
      throw bad_value("names",
                      "there is no " + (bone == no_bone ? "bone " + shown(own) + " in the skeleton"
                                                        : "joint " + shown(given) + " in the clip"),
                      "give pairs of [bone of the skeleton, joint of the clip]");
    int& place = sources[static_cast<std::size_t>(bone)];
    if (place != no_bone)
      throw bad_value("names", "bone " + shown(own) + " is given twice", "keep one pair of it");
    place = source;
  }
  return sources;
}

/// The nearest bone above that has a source.
int above(const Skeleton& to, const std::vector<int>& sources, int bone) {
  do bone = to.bones[static_cast<std::size_t>(bone)].parent;
  while (bone != no_bone && sources[static_cast<std::size_t>(bone)] == no_bone);
  return bone;
}

std::vector<double> times_of(const Motion& motion) {
  std::vector<double> keys = {0};
  for (const Track& track : motion.tracks)
    for (const auto* times : {&track.rotation.times, &track.twist.times, &track.translation.times,
                              &track.stretch.times})
      keys.insert(keys.end(), times->begin(), times->end());
  std::sort(keys.begin(), keys.end());
  std::vector<double> times;
  for (const double key : keys) {
    const double last = times.empty() ? key : times.back();
    const auto parts = static_cast<int>(std::ceil((key - last) / slowest - 0.01));
    for (int i = 1; i < parts; ++i) times.push_back(last + (key - last) * i / parts);
    if (times.empty() || key - last > same_time) times.push_back(key);
  }
  return times;
}

/// What carries the turns of one skeleton to another.
class Retargeting {
 public:
  Retargeting(const Skeleton& from, const Skeleton& to, std::vector<int> sources)
      : from_(from), to_(to), sources_(std::move(sources)) {
    next_.assign(to.size(), {});
    for (std::size_t b = 0; b < to.size(); ++b) {
      above_.push_back(sources_[b] == no_bone ? no_bone : above(to, sources_, static_cast<int>(b)));
      if (above_[b] != no_bone) next_[static_cast<std::size_t>(above_[b])].push_back(b);
    }
    align();
    measure();
  }

  Motion motion(const Motion& clip) const {
    const std::vector<double> times = times_of(clip);
    Motion made;
    std::vector<std::size_t> moved;
    for (std::size_t b = 0; b < to_.size(); ++b) {
      if (sources_[b] == no_bone) continue;
      moved.push_back(b);
      Track& track = made.tracks.emplace_back();
      track.bone = static_cast<int>(b);
      track.rotation.times = times;
      if (above_[b] == no_bone) track.translation.times = times;
    }
    PoseCursor poses(from_, clip);
    std::optional<Pose> first;
    for (const double time : times) {
      const Pose& pose = poses.at(time);
      if (!first) first = pose;
      add(pose, *first, made);
    }
    return made;
  }

  /// Bones whose rest differs, the largest difference first named.
  std::string difference() const {
    std::size_t count = 0, worst = 0;
    double most = 0;
    for (std::size_t b = 0; b < to_.size(); ++b) {
      const double angle = angles_[b];
      count += angle > told;
      if (angle > most) most = angle, worst = b;
    }
    if (count == 0) return "";
    return std::to_string(count) + (count == 1 ? " bone rests" : " bones rest") +
           " in other directions than in the clip, " + shown(to_.bones[worst].name) + " by " +
           three_digits(std::round(most)) + " degrees: they point where the clip's point";
  }

 private:
  const Bone& source(std::size_t b) const {
    return from_.bones[static_cast<std::size_t>(sources_[b])];
  }

  /// Sets the turn from each bone's rest to that of its source.
  void align() {
    aligned_.assign(to_.size(), Quat::Identity());
    angles_.assign(to_.size(), 0);
    for (std::size_t b = 0; b < to_.size(); ++b) {
      if (sources_[b] == no_bone) continue;
      if (above_[b] != no_bone) aligned_[b] = aligned_[static_cast<std::size_t>(above_[b])];
      if (next_[b].size() != 1) continue;
      const std::size_t next = next_[b].front();
      const Vec3 own = to_.bones[next].head() - to_.bones[b].head(),
                 given = source(next).head() - source(b).head();
      if (!(own.norm() > 0) || !(given.norm() > 0)) continue;
      aligned_[b] = Quat::FromTwoVectors(own, given);
      angles_[b] = 180 / pi * Quat::Identity().angularDistance(aligned_[b]);
    }
  }

  /// The ratio of lengths between bones that both have.
  void measure() {
    double own = 0, given = 0;
    for (std::size_t b = 0; b < to_.size(); ++b) {
      if (above_[b] == no_bone) continue;
      const auto up = static_cast<std::size_t>(above_[b]);
      own += (to_.bones[b].head() - to_.bones[up].head()).norm();
      given += (source(b).head() - source(up).head()).norm();
    }
    if (own > 0 && given > 0) scale_ = own / given;
    size_ = bounds(from_).diagonal().norm();
  }

  void add(const Pose& pose, const Pose& first, Motion& made) const {
    std::vector<Quat> turns(to_.size(), Quat::Identity());
    std::size_t track = 0;
    for (std::size_t b = 0; b < to_.size(); ++b) {
      const int parent = to_.bones[b].parent;
      const Quat carried =
          parent == no_bone ? Quat::Identity() : turns[static_cast<std::size_t>(parent)];
      turns[b] = carried;
      if (sources_[b] == no_bone) continue;
      const auto from = static_cast<std::size_t>(sources_[b]);
      turns[b] = Quat(pose[from].turn) * aligned_[b];
      Track& to = made.tracks[track++];
      to.rotation.values.push_back((carried.conjugate() * turns[b]).normalized());
      if (above_[b] != no_bone) continue;
      Vec3 rest = from_.bones[from].head();
      if ((first[from].frame.origin - rest).norm() > far_from_rest * size_)
        rest = first[from].frame.origin;
      to.translation.values.push_back(carried.conjugate() *
                                      (scale_ * (pose[from].frame.origin - rest)));
    }
  }

  const Skeleton &from_, &to_;
  std::vector<int> sources_, above_;
  std::vector<std::vector<std::size_t>> next_;  // bones whose nearest one above is each
  std::vector<Quat> aligned_;
  std::vector<double> angles_;  // degrees
  double scale_ = 1, size_ = 0;
};

void tell_missing(const Skeleton& from, const Skeleton& to, const std::vector<int>& sources,
                  std::vector<std::string>& warnings) {
  std::vector<std::string> joints, bones;
  for (std::size_t s = 0; s < from.size(); ++s)
    if (std::find(sources.begin(), sources.end(), static_cast<int>(s)) == sources.end())
      joints.push_back(from.bones[s].name);
  for (std::size_t b = 0; b < to.size(); ++b)
    if (sources[b] == no_bone) bones.push_back(to.bones[b].name);
  if (!joints.empty())
    warnings.push_back("motion.names leaves out " + std::to_string(joints.size()) + " of " +
                       std::to_string(from.size()) + " joints of the clip: " + some_shown(joints));
  if (!bones.empty())
    warnings.push_back("motion.names moves all but " + std::to_string(bones.size()) + " of " +
                       std::to_string(to.size()) + " bones: " + some_shown(bones));
}

}  // namespace

Retargeted retargeted(const Skeleton& from, const Clip& clip, const Skeleton& to,
                      const std::vector<NamePair>& names) {
  const std::vector<int> sources = sources_of(to, from, names);
  const Retargeting retargeting(from, to, sources);
  Retargeted made{retargeting.motion(clip.motion), {}};
  tell_missing(from, to, sources, made.warnings);
  if (std::string rest = retargeting.difference(); !rest.empty())
    made.warnings.push_back(std::move(rest));
  return made;
}

}  // namespace sinew
