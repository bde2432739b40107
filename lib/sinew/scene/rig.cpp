// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/rig.h>

#include <algorithm>

#include <sinew/core/error.h>
#include <sinew/core/text.h>
#include <sinew/rig/fit.h>
#include <sinew/rig/motion.h>
#include <sinew/rig/motion_checks.h>
#include <sinew/rig/rest_at.h>
#include <sinew/scene/body_mesh.h>
#include <sinew/scene/context.h>

namespace sinew {
namespace {

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

/// no_bone where there is none.
int bone_of_name(const Skeleton& skeleton, const std::string& name) {
  const auto found = std::find_if(skeleton.bones.begin(), skeleton.bones.end(),
                                  [&](const Bone& bone) { return bone.name == name; });
  return found == skeleton.bones.end() ? no_bone : static_cast<int>(found - skeleton.bones.begin());
}

/// The motion of one skeleton for the bones of another that have the same names.
Motion renamed(Motion motion, const Skeleton& from, const Skeleton& to) {
  std::vector<Track> tracks;
  for (Track& track : motion.tracks) {
    track.bone = bone_of_name(to, from.bones[track.bone].name);
    if (track.bone != no_bone) tracks.push_back(std::move(track));
  }
  if (tracks.empty() && !motion.tracks.empty()) {
    std::string cure("write them in motion.names, as sinew new MESH CLIP does; the clip has ");
    cure += from.bones.front().name;
    if (from.size() > 1) (cure += ", ") += from.bones[1].name;
    throw bad_input("no bone of the clip has the name of a bone of the skeleton", cure);
  }
  motion.tracks = std::move(tracks);
  for (IgnoredScale& one : motion.ignored_scales)
    one.bone = bone_of_name(to, from.bones[one.bone].name);
  std::erase_if(motion.ignored_scales, [](const IgnoredScale& one) { return one.bone == no_bone; });
  return motion;
}

/// Plays `clip` as section motion specifies, in the scene's directions and lengths.
Motion in_scene(Motion clip, const Settings& settings) {
  Motion motion =
      at_keys(settings, "motion.", [&] { return played(std::move(clip), settings.motion); });
  return placed(std::move(motion), placement_of(settings.skeleton));
}

Motion clip_motion(const Rig& rig, const Skeleton& skeleton, const Settings& settings) {
  Motion motion =
      in_scene(renamed(clip_of(rig, settings).motion, rig.skeleton, skeleton), settings);
  if (!settings.motion.preroll) motion.preroll = preroll_for(skeleton, motion);
  return motion;
}

/// The clip that gives the rest pose: the one that plays, or the first of the skeleton's file where
/// another file's plays.
const Clip& clip_at_rest(const Rig& rig, const Settings& settings) {
  const std::string& file = settings.motion.file;
  if (file.empty() || is_key_table(file) || rig.clips.empty()) return clip_of(rig, settings);
  return rig.clips.front();
}

/// Keys in the scene's directions and lengths.
Motion keyed_motion(const Settings& settings, const std::vector<TrackDefinition>& keys,
                    const Skeleton& skeleton) {
  return with_context(settings, "motion.file", [&] {
    return at_keys(settings, "motion.",
                   [&] { return played(make_motion(keys, skeleton), settings.motion); });
  });
}

/// Another file's clip for a skeleton that rests in a pose of its own clip.
Rig moved_from_rest(const Settings& settings, const Rig& skeleton, const Rig& motion) {
  Clip clip = clip_of(motion, settings);
  clip.motion = renamed(std::move(clip.motion), motion.skeleton, skeleton.skeleton);
  const Motion& own = clip_at_rest(skeleton, settings).motion;
  return with_rest_at({skeleton.skeleton, {std::move(clip)}}, own, *settings.skeleton.rest_at);
}

}  // namespace

Rig at_rest(const Settings& settings, const Rig& rig) {
  if (!settings.skeleton.rest_at) return rig;
  if (settings.binding.method == BindMethod::file)
    throw bad_input(settings.place("skeleton.rest_at"),
                    "the weights of the file are those of its own rest pose",
                    "remove it, or set binding.method to inside");
  return with_context(settings, "skeleton.rest_at", [&] {
    return with_rest_at(rig, clip_at_rest(rig, settings).motion, *settings.skeleton.rest_at);
  });
}

Skeleton skeleton_of(const Settings& settings) {
  const bool is_alone = settings.supports.empty() && settings.loads.empty() &&
                        settings.world.empty() && !settings.moves_initially();
  if (settings.bones.empty() && !is_alone) return {};
  Skeleton skeleton = at_keys(settings, "skeleton.", [&] { return make_skeleton(settings.bones); });
  return placed(std::move(skeleton), placement_of(settings.skeleton));
}

Motion motion_of(const Settings& settings, const Skeleton& skeleton) {
  return in_scene(
      at_keys(settings, "motion.",
              [&] { return make_motion(settings.tracks, skeleton, settings.motion.frame_rate); }),
      settings);
}

int bone_of(const Settings& settings, const std::string& key, const Skeleton& skeleton,
            const std::string& name) {
  return at_keys(settings, "", [&] { return bone_named(skeleton, name, key); });
}

int bone_at(const Settings& settings, const std::string& entry, const Skeleton& skeleton,
            const std::string& name) {
  return name.empty() ? no_bone : bone_of(settings, entry + ".bone", skeleton, name);
}

Settings with_fit(Settings settings) {
  if (settings.skeleton.fit == Fit::none) return settings;
  const Skeleton skeleton = rig_of(settings, read_rig_files(settings)).skeleton;
  const Placement placement = with_context(
      settings, "skeleton.fit", [&] { return fit_to(read_mesh(settings).triangles, skeleton); });
  settings.skeleton = placed_again(settings.skeleton, placement);
  settings.skeleton.fit = Fit::none;
  return settings;
}

SceneRig rig_of(const Settings& settings, const SceneFiles& files) {
  const bool own_bones = settings.skeleton.file.empty(), own_clip = settings.motion.file.empty();
  const Rig from = at_rest(settings, files.skeleton.rig);
  SceneRig scene;
  scene.skeleton =
      own_bones ? skeleton_of(settings) : placed(from.skeleton, placement_of(settings.skeleton));
  const auto moved_by = [&](const char* key, const Rig& rig) {
    return with_context(settings, key, [&] { return clip_motion(rig, scene.skeleton, settings); });
  };
  if (is_key_table(settings.motion.file))
    scene.motion = keyed_motion(settings, files.keys, scene.skeleton);
  else if (!own_clip)
    scene.motion =
        moved_by("motion.file", settings.skeleton.rest_at
                                    ? moved_from_rest(settings, files.skeleton.rig, files.motion)
                                    : files.motion);
  else if (settings.tracks.empty() && !from.clips.empty())
    scene.motion = moved_by("skeleton.file", from);
  else
    scene.motion = motion_of(settings, scene.skeleton);
  return scene;
}

std::string fit_text(const SkeletonOptions& fitted) {
  const auto list = [](const Vec3& v) {
    return '[' + three_digits(v.x()) + ", " + three_digits(v.y()) + ", " + three_digits(v.z()) +
           ']';
  };
  return "skeleton.fit: scale " + three_digits(fitted.scale) + ", rotation " +
         list(fitted.rotation) + " degrees, offset " + list(fitted.offset) + " m";
}

}  // namespace sinew
