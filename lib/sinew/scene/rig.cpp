// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/rig.h>

#include <algorithm>

#include <sinew/core/error.h>
#include <sinew/core/text.h>
#include <sinew/io/gltf/rig.h>
#include <sinew/rig/bvh/bvh.h>
#include <sinew/rig/motion.h>
#include <sinew/scene/context.h>

namespace sinew {
namespace {

bool is_bvh(const std::filesystem::path& path) {
  return lower(path.extension().string()) == ".bvh";
}

bool is_gltf(const std::filesystem::path& path) {
  const std::string type = lower(path.extension().string());
  return type == ".gltf" || type == ".glb";
}

/// In the file's own directions and units: placed() rotates and scales it afterwards.
Rig read_bvh_rig(const std::filesystem::path& path, const MotionOptions& motion) {
  BvhOptions options;
  options.name = path.stem().string();
  options.up = std::string("z");
  options.forward = std::string("x");
  options.rate = motion.frame_rate.value_or(0);
  options.positions =
      motion.positions == Positions::add ? BvhPositions::add : BvhPositions::replace;
  return rig_of(read_bvh(path), options);
}

std::string names_of(const std::vector<Clip>& clips) {
  std::vector<std::string_view> names;
  names.reserve(clips.size());
  for (const Clip& clip : clips) names.emplace_back(clip.name);
  return listed(names);
}

/// The clip that the scene names, or the only one.
const Clip& clip_of(const Rig& rig, const Settings& settings) {
  const std::string& wanted = settings.motion.clip;
  if (!wanted.empty()) return find_clip(rig.clips, wanted);
  if (rig.clips.empty())
    throw bad_input("the file holds no motion", "name one that does in motion.file");
  if (rig.clips.size() > 1)
    throw bad_input("the file holds several clips",
                    std::string("name one in motion.clip: ").append(names_of(rig.clips)));
  return rig.clips.front();
}

/// The motion of one skeleton for the bones of another that have the same names.
Motion renamed(Motion motion, const Skeleton& from, const Skeleton& to) {
  std::vector<Track> tracks;
  for (Track& track : motion.tracks) {
    const auto found = std::find_if(to.bones.begin(), to.bones.end(), [&](const Bone& bone) {
      return bone.name == from.bones[track.bone].name;
    });
    if (found == to.bones.end()) continue;
    track.bone = static_cast<int>(found - to.bones.begin());
    tracks.push_back(std::move(track));
  }
  if (tracks.empty()) {
    std::string cure("name a bone of the skeleton as the clip does: ");
    cure += from.bones.front().name;
    if (from.size() > 1) (cure += ", ") += from.bones[1].name;
    throw bad_input("no bone of the clip has the name of a bone of the skeleton", cure);
  }
  motion.tracks = std::move(tracks);
  return motion;
}

/// As section motion specifies, in the scene's directions and lengths.
Motion in_scene(Motion clip, const Settings& settings) {
  Motion motion =
      at_keys(settings, "motion.", [&] { return played(std::move(clip), settings.motion); });
  return placed(std::move(motion), settings.skeleton.scale, to_scene(settings.skeleton));
}

Motion clip_motion(const Rig& rig, const Skeleton& skeleton, const Settings& settings) {
  return in_scene(renamed(clip_of(rig, settings).motion, rig.skeleton, skeleton), settings);
}

}  // namespace

bool holds_rig(const std::filesystem::path& path) {
  return is_bvh(path) || (is_gltf(path) && has_skin(path));
}

bool holds_mesh(const std::filesystem::path& path) { return !is_bvh(path); }

Rig read_rig(const std::filesystem::path& path, const MotionOptions& motion) {
  if (is_bvh(path)) return read_bvh_rig(path, motion);
  if (is_gltf(path)) return read_gltf_rig(path).rig;
  throw bad_input(Place{path.string()}, "is no rig that can be read",
                  std::string("give a file of YAML, ") + rig_formats);
}

Skeleton skeleton_of(const Settings& settings) {
  Skeleton skeleton = at_keys(settings, "skeleton.", [&] { return make_skeleton(settings.bones); });
  return placed(std::move(skeleton), settings.skeleton.scale, to_scene(settings.skeleton));
}

Motion motion_of(const Settings& settings, const Skeleton& skeleton) {
  return in_scene(
      at_keys(settings, "motion.",
              [&] { return make_motion(settings.tracks, skeleton, settings.motion.frame_rate); }),
      settings);
}

SceneRig rig_of(const Settings& settings) {
  SceneRig scene;
  const std::string &skeleton = settings.skeleton.file, &motion = settings.motion.file;
  Rig rig;
  if (skeleton.empty()) {
    scene.skeleton = skeleton_of(settings);
  } else {
    rig = with_context(settings, "skeleton.file",
                       [&] { return read_rig(skeleton, settings.motion); });
    scene.skeleton = placed(rig.skeleton, settings.skeleton.scale, to_scene(settings.skeleton));
  }
  if (!motion.empty()) {
    scene.motion = with_context(settings, "motion.file", [&] {
      return clip_motion(read_rig(motion, settings.motion), scene.skeleton, settings);
    });
  } else if (settings.tracks.empty() && !rig.clips.empty()) {
    scene.motion = with_context(settings, "skeleton.file",
                                [&] { return clip_motion(rig, scene.skeleton, settings); });
  } else {
    scene.motion = motion_of(settings, scene.skeleton);
  }
  return scene;
}

}  // namespace sinew
