// SPDX-License-Identifier: GPL-3.0-or-later
#include "rig/motion.h"

#include <algorithm>
#include <cmath>

#include "rig/rotation_vector.h"

namespace sinew {
namespace {

/// A moment of the clip, and how fast it passes there: 1, 0 where it holds, -1 on the way back.
struct ClipTime {
  double time, speed;
};

/// `passed` s after the clip has begun; before that it holds its beginning.
ClipTime clip_time(const Motion& motion, double passed) {
  if (passed < 0) return {motion.start, 0};
  const double length = clip_length(motion);
  const bool within = passed < length;
  if (within || motion.extrapolation == Extrapolation::hold || !(length > 0))
    return {motion.start + std::min(passed, length), within ? 1.0 : 0.0};
  if (motion.extrapolation == Extrapolation::loop)
    return {motion.start + std::fmod(passed, length), 1};
  const double way = std::fmod(passed, 2 * length);
  if (way < length) return {motion.start + way, 1};
  return {motion.start + 2 * length - way, -1};
}

void slow_down(LocalMotion& motion, double speed) {
  if (speed == 1) return;
  motion.angular_velocity *= speed;
  motion.twist_rate *= speed;
  motion.velocity *= speed;
  motion.stretch_rate *= speed;
}

/// On the way from rest to `goal`: a share `way` of it, which grows by `rate` per second.
LocalMotion ramped(const LocalMotion& goal, double way, double rate) {
  const Vec3 turn = rotation_vector(goal.rotation);
  LocalMotion motion;
  motion.rotation = rotation_by(way * turn);
  motion.angular_velocity = rate * turn;
  motion.twist = way * goal.twist;
  motion.twist_rate = rate * goal.twist;
  motion.translation = way * goal.translation;
  motion.velocity = rate * goal.translation;
  motion.stretch = 1 + way * (goal.stretch - 1);
  motion.stretch_rate = rate * (goal.stretch - 1);
  return motion;
}

}  // namespace

LocalMotion Track::at(double time) const {
  LocalMotion motion;
  if (!rotation.empty()) {
    const auto sample = rotation.at(time);
    motion.rotation = sample.value;
    motion.angular_velocity = sample.angular_velocity;
  }
  if (!twist.empty()) {
    const auto sample = twist.at(time);
    motion.twist = sample.value;
    motion.twist_rate = sample.rate;
  }
  if (!translation.empty()) {
    const auto sample = translation.at(time);
    motion.translation = sample.value;
    motion.velocity = sample.rate;
  }
  if (!stretch.empty()) {
    const auto sample = stretch.at(time);
    motion.stretch = sample.value;
    motion.stretch_rate = sample.rate;
  }
  return motion;
}

double last_key(const Track& track) {
  double last = 0;
  for (const auto* times :
       {&track.rotation.times, &track.twist.times, &track.translation.times, &track.stretch.times})
    if (!times->empty()) last = std::max(last, times->back());
  return last;
}

double last_key(const Motion& motion) {
  double last = 0;
  for (const Track& track : motion.tracks) last = std::max(last, last_key(track));
  return last;
}

double clip_length(const Motion& motion) {
  return std::max(0.0, (motion.end ? *motion.end : last_key(motion)) - motion.start);
}

bool stretches(const Motion& motion) {
  return std::any_of(motion.tracks.begin(), motion.tracks.end(), [](const Track& track) {
    const auto& values = track.stretch.values;
    return std::any_of(values.begin(), values.end(), [](double value) { return value != 1; });
  });
}

std::vector<LocalMotion> local_motions(const Motion& motion, std::size_t bones, double time) {
  std::vector<LocalMotion> local(bones);
  const ClipTime moment = clip_time(motion, time - motion.preroll);
  const bool ramp = time < motion.preroll && motion.preroll > 0;
  const double s = ramp ? std::max(0.0, time / motion.preroll) : 1;
  for (const Track& track : motion.tracks) {
    LocalMotion& its = local[static_cast<std::size_t>(track.bone)];
    its = track.at(moment.time);
    if (ramp)
      its = ramped(its, s * s * (3 - 2 * s), 6 * s * (1 - s) / motion.preroll);
    else
      slow_down(its, moment.speed);
  }
  return local;
}

}  // namespace sinew
