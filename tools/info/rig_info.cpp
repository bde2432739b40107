// SPDX-License-Identifier: GPL-3.0-or-later
#include "info/rig_info.h"

#include <algorithm>
#include <cmath>

#include <sinew/core/particles.h>
#include <sinew/core/text.h>
#include <sinew/physics/time_step.h>
#include <sinew/rig/motion.h>

namespace sinew {
namespace {

using Json = nlohmann::ordered_json;

constexpr int least_samples = 200;  // of a clip, for its largest speed

/// The largest speed of any bone's head or tail in a clip, m/s.
double largest_speed(const Skeleton& skeleton, const Clip& clip) {
  const int samples = std::max(least_samples, 2 * clip.frames);
  double fastest = 0;
  PoseCursor poses(skeleton, clip.motion);
  for (int sample = 0; sample <= samples; ++sample) {
    const Pose& pose = poses.at(clip.duration * sample / samples);
    for (std::size_t b = 0; b < pose.size(); ++b) {
      const double length = pose[b].stretch * skeleton.bones[b].length;
      const Vec3 tail = pose[b].frame.origin + length * pose[b].axis();
      fastest = std::max({fastest, pose[b].velocity.norm(), pose[b].velocity_at(tail).norm()});
    }
  }
  return fastest;
}

/// The step that a body of the default material takes by itself, s.
double usual_step(double radius) {
  const MaterialOptions settings;
  const Material material =
      make_material(settings, radius, settings.density * volume_per_particle(radius));
  const SolverSettings solver;
  return solver.time_step_factor * step_limit(solver.integrator, material, {});
}

void add_tree(const Skeleton& skeleton, int parent, const std::string& indent, Results& results) {
  for (std::size_t b = 0; b < skeleton.size(); ++b) {
    if (skeleton.bones[b].parent != parent) continue;
    results.add_line(indent + skeleton.bones[b].name, skeleton.bones[b].length, "m");
    add_tree(skeleton, static_cast<int>(b), indent + "  ", results);
  }
}

Json listed(const std::vector<Clip>& clips) {
  Json list = Json::array();
  for (const Clip& clip : clips)
    list.push_back({{"name", clip.name},
                    {"frames", clip.frames},
                    {"frame_time", clip.frame_time},
                    {"duration", clip.duration}});
  return list;
}

Json listed(const Skeleton& skeleton) {
  Json list = Json::array();
  for (const Bone& bone : skeleton.bones)
    list.push_back({{"name", bone.name}, {"parent", bone.parent}, {"length", bone.length}});
  return list;
}

}  // namespace

void add_clip_info(const std::vector<Clip>& clips, Results& results) {
  const Clip none;
  const Clip& first = clips.empty() ? none : clips.front();
  results.add("frames", first.frames);
  results.add("frame_time", first.frame_time, "s");
  results.add("duration", first.duration, "s");
  for (const Clip& clip : clips) results.add_line("clip", clip.name);
  results.add_value("clips", listed(clips));
}

void add_rig_info(const Rig& rig, std::optional<double> radius, Results& results) {
  results.add("bones", rig.skeleton.size());
  add_clip_info(rig.clips, results);
  if (radius) {
    double fastest = 0;
    for (const Clip& clip : rig.clips)
      fastest = std::max(fastest, largest_speed(rig.skeleton, clip));
    const double step = usual_step(*radius);
    results.add("bone_speed", fastest * step / *radius,
                "radii per step of " + three_digits(step) + " s, that of the default material");
  }
  add_tree(rig.skeleton, no_bone, "", results);
  results.add_value("skeleton", listed(rig.skeleton));
}

Clip clip_of(Motion motion, std::string name, std::optional<double> frame_rate) {
  Clip clip{std::move(name), std::move(motion)};
  clip.duration = clip_length(clip.motion);
  if (!frame_rate) return clip;
  clip.frame_time = 1 / *frame_rate;
  clip.frames = static_cast<int>(std::lround(clip.duration * *frame_rate)) + 1;
  return clip;
}

void add_rig_alone_info(const Settings& settings, const std::string& name,
                        std::optional<double> radius, Results& results) {
  if (!settings.bones.empty()) return add_rig_info({make_skeleton(settings), {}}, radius, results);
  Skeleton named;  // whose bones a clip moves
  Json moves = Json::array();
  for (const TrackDefinition& track : settings.tracks) {
    if (std::find(moves.begin(), moves.end(), track.bone) != moves.end()) continue;
    named.bones.push_back({track.bone, no_bone, 1, {}});
    moves.push_back(track.bone);
  }
  const Clip clip = clip_of(make_motion(settings, named), name, settings.motion.frame_rate);
  results.add("tracks", clip.motion.tracks.size());
  add_clip_info({clip}, results);
  results.add("moves", moves);
}

}  // namespace sinew
