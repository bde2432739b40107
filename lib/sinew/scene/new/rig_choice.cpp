// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/new/new_scene.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

#include <sinew/core/error.h>
#include <sinew/core/text.h>
#include <sinew/io/gltf/converted.h>
#include <sinew/mesh/winding.h>
#include <sinew/rig/fit.h>
#include <sinew/rig/motion.h>
#include <sinew/rig/motion_checks.h>
#include <sinew/rig/rest_at.h>
#include <sinew/rig/retarget.h>
#include <sinew/scene/first_pose.h>
#include <sinew/scene/scene_files.h>

namespace sinew {
namespace {

constexpr double min_fraction = 0.5;  // fraction of the bones in a mesh that is theirs
constexpr double longest_clip = 3;    // s of the scene, for a first picture
constexpr double min_wait = 0.1;      // s of a clip before its first key, to be left out
constexpr double well_inside = 0.8;   // a fraction that no fit improves
constexpr int places_per_bone = 5;

struct Axes {
  Axis up;
  std::optional<Axis> forward;
};

constexpr std::array<Axes, 2> usual_axes = {{{Axis::y, Axis::z}, {Axis::z, std::nullopt}}};

/// Finds the fraction of the bones' length that is inside.
double fraction_inside(const Skeleton& skeleton, const Winding& winding) {
  double inside = 0, all = 0;
  for (const Bone& bone : skeleton.bones)
    for (int i = 0; i < places_per_bone; ++i) {
      const Vec3 place = bone.head() + (i + 0.5) / places_per_bone * bone.length * bone.axis();
      all += bone.length;
      if (winding.around(place).value_or(0) > 0) inside += bone.length;
    }
  return inside / all;
}

struct Placing {
  Axes mesh, rig;
  double scale = 1, fraction = -1;
};

/// Units in which rigs come, the mesh's own first, and what makes both equally high.
std::vector<double> scales_of(const Skeleton& skeleton, const Surface& surface, LengthUnit unit) {
  const double high = bounds(surface.triangles.points).sizes().maxCoeff();
  return {meters(unit), 1,      0.01,
          0.001,        0.0254, high / std::max(bounds(skeleton).sizes().maxCoeff(), 1e-12)};
}

/// The placing with which most of the bones lies inside; the first one of equals.
Placing placing_of(const Skeleton& skeleton, const Surface& surface, const BodyOptions& body) {
  Placing best;
  const Winding winding = winding_of(surface);
  const Mat3 now = to_scene(body);
  const std::vector<double> scales = scales_of(skeleton, surface, body.unit);
  for (const Axes& mesh : {Axes{body.up, body.forward}, usual_axes[0], usual_axes[1]}) {
    BodyOptions turned;
    turned.up = mesh.up, turned.forward = mesh.forward;
    for (const Axes& rig : usual_axes) {
      SkeletonOptions axes;
      axes.up = rig.up, axes.forward = rig.forward;
      const Mat3 turn = now * to_scene(turned).transpose() * to_scene(axes);
      for (const double scale : scales) {
        const double fraction = fraction_inside(placed(skeleton, Placement{scale, turn}), winding);
        if (fraction > best.fraction + 0.02) best = {mesh, rig, scale, fraction};
      }
    }
  }
  return best;
}

/// Brings a rig into the mesh that lies elsewhere or in another pose, with the axes as they are.
void fit_if_better(const Surface& surface, const Skeleton& skeleton, Settings& settings,
                   Placing& placing) {
  if (placing.fraction >= well_inside) return;
  const Skeleton there = placed(skeleton, placement_of(settings.skeleton));
  const Placement fit = fit_to(surface.triangles, there);
  const double fraction = fraction_inside(placed(there, fit), winding_of(surface));
  if (fraction <= placing.fraction + 0.1) return;
  settings.skeleton.fit = Fit::mesh;
  placing.mesh = {settings.body.up, settings.body.forward};
  placing.fraction = fraction;
}

/// Whether each bone moves flesh: vertices follow it, or one below it. All do without weights.
std::vector<bool> with_flesh(const SkinnedRig& rig) {
  const std::vector<Bone>& bones = rig.rig.skeleton.bones;
  std::vector<bool> with(bones.size(), rig.weights.weights.empty());
  for (const BoneWeight& weight : rig.weights.weights) with[weight.bone] = true;
  for (std::size_t b = bones.size(); b-- > 0;)
    if (with[b] && bones[b].parent != no_bone) with[bones[b].parent] = true;
  return with;
}

/// Grade of a clip for a first scene: 0 for a still pose, the highest for a walk.
int grade(const Clip& clip, const Skeleton& skeleton, const std::vector<bool>& flesh) {
  const MovingBones bones = moving_bones(skeleton, clip.motion);
  const auto moves_flesh = [&](int bone) { return flesh[static_cast<std::size_t>(bone)]; };
  if (std::none_of(bones.turned.begin(), bones.turned.end(), moves_flesh))
    return std::any_of(bones.all.begin(), bones.all.end(), moves_flesh) ? 2 : !bones.all.empty();
  const bool walks = lower(clip.name).find("walk") != std::string::npos;
  return 3 + !largest_scale(clip.motion, flesh) + 2 * walks;
}

/// The first clip of the best grade; none where all clips are still poses.
const Clip* moving_clip(const SkinnedRig& rig) {
  const std::vector<bool> flesh = with_flesh(rig);
  const Clip* best = nullptr;
  int highest = 0;
  for (const Clip& clip : rig.rig.clips)
    if (const int grade_of_clip = grade(clip, rig.rig.skeleton, flesh); grade_of_clip > highest)
      best = &clip, highest = grade_of_clip;
  return best;
}

void choose_clip(const Rig& rig, const Clip& clip, NewChoices& choices) {
  MotionOptions& motion = choices.settings.motion;
  if (rig.clips.size() > 1) motion.clip = clip.name;
  for (const Clip& other : rig.clips)
    if (&other != &clip) choices.clips.push_back(shown(other.name));
  motion.begin = Begin::automatic;
  choices.begins_posed = begins_far_from_rest(rig.skeleton, clip.motion);
  const double preroll = choices.begins_posed ? 0 : preroll_for(rig.skeleton, clip.motion);
  const double begin = first_key(clip.motion);
  if (begin > min_wait) motion.start = begin;
  const double length = begin + clip.duration - motion.start,
               played = std::min(length, longest_clip);
  choices.clip_note = "The clip " + shown(clip.name) + " of the file, " + three_digits(length) +
                      " s long" + (motion.start > 0 ? " from its first key" : "");
  if (played < length) choices.clip_note += "; solver.duration shows its beginning";
  choices.clip_note += '.';
  choices.settings.solver.duration =
      std::max(std::round((preroll + played + rest_after) * 100) / 100, rest_after);
}

/// Bends the bones that hold no others, where a rig has no clip.
void bend_ends(const Skeleton& skeleton, NewChoices& choices) {
  std::vector<bool> holds(skeleton.size());
  for (const Bone& bone : skeleton.bones)
    if (bone.parent >= 0) holds[bone.parent] = true;
  for (std::size_t b = 0; b < skeleton.size(); ++b) {
    if (holds[b]) continue;
    TrackDefinition& track = choices.settings.tracks.emplace_back();
    track.bone = skeleton.bones[b].name;
    const Vec3 axis = skeleton.bones[b].rest.rotation.col(1);
    for (const auto& [time, angle] :
         {std::pair{0.0, 0.0}, {0.5, 20.0}, {0.75, 20.0}, {1.25, 0.0}}) {
      KeyDefinition& key = track.keys.emplace_back();
      key.time = time, key.axis = axis, key.angle = angle;
    }
  }
  choices.settings.solver.duration = 1.25 + rest_after;
}

void choose_motion(const SkinnedRig& skinned, NewChoices& choices) {
  const Rig& rig = skinned.rig;
  const Clip* clip =
      choices.clip.empty() ? moving_clip(skinned) : &find_clip(rig.clips, choices.clip);
  if (clip != nullptr)
    choose_clip(rig, *clip, choices);
  else
    bend_ends(rig.skeleton, choices);
}

/// Clips of another file, whose joints have other names or another rest than the bones of a
/// skeleton; none where too few of them have a counterpart.
std::vector<Clip> retargeted_clips(const Skeleton& skeleton, const std::string& given,
                                   Settings& settings) {
  constexpr std::size_t fewest = 3;
  const Skeleton joints = read_rig(given, {}).rig.skeleton;
  settings.motion.names = matched_names(skeleton, joints);
  const std::size_t matched = settings.motion.names.size();
  if (matched >= fewest && 2 * matched >= std::min(skeleton.size(), joints.size()))
    return read_rig_files(settings).motion.clips;
  settings.motion.names.clear();
  return {};
}

/// The mesh's own rig with the clips of another file where they move its bones, else the other rig.
SkinnedRig with_clips_of(const std::string& own, const std::string& given, SkinnedRig rig,
                         Settings& settings) {
  settings.skeleton.file = own, settings.motion.file = given;
  if (!is_gltf(given))
    if (auto clips = retargeted_clips(rig.rig.skeleton, given, settings); !clips.empty()) {
      rig.rig.clips = std::move(clips);
      return rig;
    }
  const auto is_own = [&](const Bone& bone) {
    return std::any_of(rig.rig.skeleton.bones.begin(), rig.rig.skeleton.bones.end(),
                       [&](const Bone& one) { return one.name == bone.name; });
  };
  try {
    Rig clips = read_rig_files(settings).motion;
    const auto& bones = clips.skeleton.bones;
    if (std::count_if(bones.begin(), bones.end(), is_own) * 2 >= std::ssize(bones)) {
      rig.rig.clips = std::move(clips.clips);
      return rig;
    }
  } catch (const Error&) {  // no bone has a name of the other file's
  }
  if (auto clips = retargeted_clips(rig.rig.skeleton, given, settings); !clips.empty()) {
    rig.rig.clips = std::move(clips);
    return rig;
  }
  settings.skeleton.file.clear(), settings.motion.file.clear();
  return read_rig(given, {});
}

}  // namespace

std::string rig_within(const std::string& mesh) { return holds_rig(mesh) ? mesh : ""; }

Surface use_rig(const std::string& given, Surface surface, NewChoices& choices) {
  Settings& settings = choices.settings;
  const std::string own = rig_within(settings.body.mesh);
  SkinnedRig rig = read_rig(own.empty() ? given : own, {});
  if (!own.empty() && own != given) rig = with_clips_of(own, given, std::move(rig), settings);
  const std::string& path = settings.motion.file.empty() ? given : own;
  const Skeleton& skeleton = rig.rig.skeleton;
  const bool same = path == settings.body.mesh;
  Placing placing = same ? Placing{usual_axes[0], usual_axes[0], meters(settings.body.unit), 1}
                         : placing_of(skeleton, surface, settings.body);
  settings.skeleton.file = path;
  settings.skeleton.up = placing.rig.up, settings.skeleton.forward = placing.rig.forward;
  settings.skeleton.scale = placing.scale;
  fit_if_better(surface, skeleton, settings, placing);
  if (settings.body.up != placing.mesh.up) {
    const Mat3 before = to_scene(settings.body);
    settings.body.up = placing.mesh.up, settings.body.forward = placing.mesh.forward;
    const Mat3 turn = to_scene(settings.body) * before.transpose();
    for (Triangles* part : {&surface.triangles, &surface.caps})
      for (Vec3& point : part->points) point = turn * point;
    choices.axes = "the bones of the rig lie so";
  }
  settings.body.forward = placing.mesh.forward;
  choices.bones = std::to_string(skeleton.size()) + " bones of the rig, " +
                  three_digits(std::round(100 * placing.fraction)) + " % of them inside the mesh";
  if (settings.skeleton.fit == Fit::mesh) choices.bones += ", where skeleton.fit brings them";
  if (same) choices.bones = std::to_string(skeleton.size()) + " bones of the file itself";
  if (placing.fraction < min_fraction) choices.bones += ": see skeleton.scale, up and forward";
  if (!rig.weights.weights.empty() && placing.fraction >= min_fraction)
    settings.binding.method = BindMethod::file;
  choose_motion(rig, choices);
  return surface;
}

void use_rig(const RigBody& figure, const Surface& surface, NewChoices& choices) {
  Settings& settings = choices.settings;
  settings.skeleton = figure.skeleton;
  Rig rig = read_rig(figure.skeleton.file, {}).rig;
  if (figure.skeleton.rest_at)
    rig = with_rest_at(rig, rig.clips.front().motion, *figure.skeleton.rest_at);
  const double fraction =
      fraction_inside(placed(rig.skeleton, placement_of(settings.skeleton)), winding_of(surface));
  choices.unit = figure.unit, choices.axes = figure.axes, choices.pose = figure.pose;
  choices.bones = std::to_string(rig.skeleton.size()) + " bones of the rig, " +
                  three_digits(std::round(100 * fraction)) + " % of them inside the mesh";
  choose_motion({std::move(rig), {}, {}}, choices);
}

}  // namespace sinew
