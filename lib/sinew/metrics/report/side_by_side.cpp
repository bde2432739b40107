// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include <sinew/core/vector.h>
#include <sinew/metrics/report/playback.h>

namespace sinew {
namespace {

constexpr double gap = 0.15;  // between the two, of the size of the first

/// From where the second playback is to where it stands beside the first. The camera looks along x or
/// y, whichever has less: it sees both when they stand along the other.
Vec3 way_aside(const Playback& first, const Playback& second) {
  const Box one = box_of(first), other = box_of(second);
  if (one.isEmpty() || other.isEmpty()) return Vec3::Zero();
  const Vec3 size = one.sizes().cwiseMax(other.sizes());
  const int axis = size.x() >= size.y() ? 0 : 1;
  Vec3 way = Vec3::Zero();
  way[axis] = one.max()[axis] - other.min()[axis] + gap * size[axis];
  return way;
}

void append_moved(std::vector<float>& all, const std::vector<float>& places, const Vec3& way) {
  for (std::size_t i = 0; i < places.size(); ++i)
    all.push_back(static_cast<float>(places[i] + way[static_cast<int>(i % 3)]));
}

/// Not-a-number for the playback that has no such values.
void append_values(std::vector<float>& all, std::vector<float> values, std::size_t before,
                   std::size_t count) {
  if (all.empty() && values.empty()) return;
  all.resize(before, std::numeric_limits<float>::quiet_NaN());
  values.resize(count, std::numeric_limits<float>::quiet_NaN());
  all.insert(all.end(), values.begin(), values.end());
}

/// The places and fields of a frame, those of the second behind.
PlaybackFrame joined(PlaybackFrame frame, const PlaybackFrame& other, const Vec3& way) {
  const std::size_t before = frame.particles.size() / 3, count = other.particles.size() / 3;
  for (std::size_t f = 0; f < frame.values.size(); ++f)
    append_values(frame.values[f], other.values[f], before, count);
  append_moved(frame.particles, other.particles, way);
  append_moved(frame.surface, other.surface, way);
  append_moved(frame.bones, other.bones, way);
  return frame;
}

void join_shape(Playback& playback, const Playback& second, const std::array<std::string, 2>& prefixes) {
  const auto bones = static_cast<int>(playback.bone_names.size());
  const auto points = static_cast<int>(playback.points.size());
  for (std::string& name : playback.bone_names) name = prefixes[0] + name;
  for (const std::string& name : second.bone_names) playback.bone_names.push_back(prefixes[1] + name);
  for (const int bone : second.bone) playback.bone.push_back(bone < 0 ? -1 : bone + bones);
  for (const auto& [a, b, c] : second.faces)
    playback.faces.push_back({a + points, b + points, c + points});
  playback.particles.insert(playback.particles.end(), second.particles.begin(), second.particles.end());
  playback.balls.insert(playback.balls.end(), second.balls.begin(), second.balls.end());
  playback.points.insert(playback.points.end(), second.points.begin(), second.points.end());
  playback.run_particles += second.run_particles;
  playback.run_points += second.run_points;
}

}  // namespace

Playback side_by_side(const Playback& first, const Playback& second,
                  const std::array<std::string, 2>& prefixes) {
  Playback playback = first;
  const Vec3 way = way_aside(first, second);
  playback.frames.clear();
  for (const PlaybackFrame& frame : first.frames) {
    const auto other = std::find_if(second.frames.begin(), second.frames.end(),
                                    [&](const PlaybackFrame& one) { return one.frame == frame.frame; });
    if (other != second.frames.end()) playback.frames.push_back(joined(frame, *other, way));
  }
  join_shape(playback, second, prefixes);
  return playback;
}

}  // namespace sinew
