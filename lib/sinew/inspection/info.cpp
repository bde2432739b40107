// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/inspection/info.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include <sinew/analysis/time_step.h>
#include <sinew/core/particles.h>
#include <sinew/core/text.h>
#include <sinew/inspection/mesh_info.h>
#include <sinew/io/checksums.h>
#include <sinew/io/gltf/geometry.h>
#include <sinew/rig/motion.h>
#include <sinew/rig/motion_checks.h>
#include <sinew/run/run_folder.h>
#include <sinew/run/run_record.h>
#include <sinew/scene/body_mesh.h>
#include <sinew/scene/rig.h>
#include <sinew/scene/scene_files.h>
#include <sinew/settings/sections.h>

namespace sinew {
namespace {

using Json = nlohmann::ordered_json;

constexpr int min_samples = 200;  // samples of a clip, for its largest speed

/// s before a clip moves.
double wait_of(const Clip& clip) {
  return std::max(0.0, first_key(clip.motion) - clip.motion.start);
}

/// The largest speed of any bone's head or tail in a clip, m/s.
double largest_speed(const Skeleton& skeleton, const Clip& clip) {
  const double wait = wait_of(clip);
  const int samples = std::max(min_samples, 2 * clip.frames);
  double fastest = 0;
  PoseCursor poses(skeleton, clip.motion);
  for (int sample = 0; sample <= samples; ++sample) {
    const Pose& pose = poses.at(wait + clip.duration * sample / samples);
    for (std::size_t b = 0; b < pose.size(); ++b) {
      const double length = pose[b].stretch * skeleton.bones[b].length;
      const Vec3 tail = pose[b].frame.origin + length * pose[b].axis();
      fastest = std::max({fastest, pose[b].velocity.norm(), pose[b].velocity_at(tail).norm()});
    }
  }
  return fastest;
}

/// The default time step of a body of the default material, s.
double usual_step(double radius) {
  const MaterialOptions settings;
  const Material material =
      make_material(settings, {radius, settings.density * volume_per_particle(radius)});
  const SolverSettings solver;
  return solver.time_step_factor * step_limit(solver.integrator, material, {});
}

void add_tree(const Skeleton& skeleton, int parent, const std::string& indent, Findings& results) {
  for (std::size_t b = 0; b < skeleton.size(); ++b) {
    if (skeleton.bones[b].parent != parent) continue;
    results.add_line(indent + skeleton.bones[b].name, skeleton.bones[b].length, "m");
    add_tree(skeleton, static_cast<int>(b), indent + "  ", results);
  }
}

Json names_of(const Skeleton& skeleton, const std::vector<int>& bones) {
  Json names = Json::array();
  for (const int bone : bones) names.push_back(skeleton.bones[static_cast<std::size_t>(bone)].name);
  return names;
}

Json listed(const Skeleton& skeleton, const std::vector<Clip>& clips) {
  Json list = Json::array();
  for (const Clip& clip : clips)
    list.push_back({{"name", clip.name},
                    {"moves", names_of(skeleton, moving_bones(skeleton, clip.motion).all)},
                    {"frames", clip.frames},
                    {"frame_time", clip.frame_time},
                    {"begin", wait_of(clip)},
                    {"duration", clip.duration}});
  return list;
}

Json listed(const Skeleton& skeleton) {
  Json list = Json::array();
  for (const Bone& bone : skeleton.bones)
    list.push_back({{"name", bone.name}, {"parent", bone.parent}, {"length", bone.length}});
  return list;
}

void add_clip_info(const Skeleton& skeleton, const std::vector<Clip>& clips, Findings& results) {
  const Clip none;
  const Clip& first = clips.empty() ? none : clips.front();
  results.add("frames", first.frames);
  results.add("frame_time", first.frame_time, "s");
  if (wait_of(first) > 0) results.add("begin", wait_of(first), "s");
  results.add("duration", first.duration, "s");
  for (const Clip& clip : clips) {
    results.add_line("clip", clip.name);
    const std::size_t moving = moving_bones(skeleton, clip.motion).all.size();
    results.add_line("  moves", std::to_string(moving) + " of " + std::to_string(skeleton.size()) +
                                    " bones in " + three_digits(clip.duration) + " s");
  }
  results.add_value("clips", listed(skeleton, clips));
}

void add_rig_info(const Rig& rig, std::optional<double> radius, Findings& results) {
  results.add("bones", rig.skeleton.size());
  add_clip_info(rig.skeleton, rig.clips, results);
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
  clip.duration = clip_length(clip.motion) - wait_of(clip);
  if (!frame_rate) return clip;
  clip.frame_time = 1 / *frame_rate;
  clip.frames = static_cast<int>(std::lround(clip.duration * *frame_rate)) + 1;
  return clip;
}

void add_rig_alone_info(const Settings& settings, const std::string& name,
                        std::optional<double> radius, Findings& results) {
  if (!settings.bones.empty()) return add_rig_info({skeleton_of(settings), {}}, radius, results);
  Skeleton named;  // skeleton of the bones that a clip moves
  Json moves = Json::array();
  for (const TrackDefinition& track : settings.tracks) {
    if (std::find(moves.begin(), moves.end(), track.bone) != moves.end()) continue;
    named.bones.push_back({track.bone, no_bone, 1, {}});
    moves.push_back(track.bone);
  }
  const Clip clip = clip_of(motion_of(settings, named), name, settings.motion.frame_rate);
  results.add("tracks", clip.motion.tracks.size());
  add_clip_info(named, {clip}, results);
  results.add("moves", moves);
}

void add_verified(const RunFolder& folder, Findings& results, VerifiedFiles& files) {
  files = verify_checksums(folder.path);
  results.add("verified", files.files);
  for (const std::string& name : files.damaged) results.add_line("damaged", name);
  for (const std::string& name : files.missing) results.add_line("missing", name);
  results.add_value("damaged", files.damaged);
  results.add_value("missing", files.missing);
}

Info info_of_run(const InfoOptions& options) {
  const RunFolder folder{options.path};
  if (!folder.used())
    throw bad_input(Place{options.path}, "is not the folder of a run",
                    "give a file, or the folder that sinew run or sinew simulate writes");
  const auto record = read_record(folder);
  Info info;
  info.findings.add("folder", options.path);
  for (const char* key : {"version", "status", "started", "particles", "bones", "frames", "steps",
                          "time_step", "duration"})
    if (const auto value = record.find(key); value != record.end())
      info.findings.add(key, value->is_array() ? Json(value->size()) : *value);
  if (!options.verify) return info;
  VerifiedFiles files;
  add_verified(folder, info.findings, files);
  const std::size_t wrong = files.damaged.size() + files.missing.size();
  if (wrong > 0)
    info.damage = bad_input(Place{options.path},
                            std::to_string(wrong) + " of " + std::to_string(files.files) +
                                " files are damaged or missing",
                            "restore them from a copy, or run the scene again with --force");
  return info;
}

void add_scene(const Settings& settings, Findings& results) {
  SceneRig scene = rig_of(settings, read_rig_files(settings));
  results.add("mesh", settings.body.mesh);
  results.add("tracks", scene.motion.tracks.size());
  Clip clip = clip_of(std::move(scene.motion), "scene", settings.motion.frame_rate);
  add_rig_info({std::move(scene.skeleton), {std::move(clip)}}, settings.body.radius, results);
}

BodyOptions body_of_mesh(const InfoOptions& options) {
  std::vector<Override> overrides = options.overrides;
  overrides.push_back({"body.count", "1000", "--count 1000"});  // not used, but required of a body
  return settings_of_mesh(options.path, overrides).body;
}

/// Whether the file is a rig or clip in YAML, without anything else.
bool add_rig_alone(const InfoOptions& options, Findings& results) {
  if (!is_scene(options.path)) return false;
  const auto alone = read_rig_alone(options.path);
  if (!alone) return false;
  const std::string name = std::filesystem::path(options.path).stem().string();
  add_rig_alone_info(*alone, name, options.radius, results);
  return true;
}

/// The parts of a file that has several.
void add_parts(const std::string& path, Findings& results) {
  constexpr std::size_t most = 12;
  if (!is_gltf(path)) return;
  const std::vector<std::string> names = gltf_mesh_names(path);
  for (std::size_t i = 0; i < std::min(most, names.size()); ++i) results.add_line("mesh", names[i]);
  if (names.size() > most)
    results.add_line("mesh", "and " + std::to_string(names.size() - most) + " more (--json)");
  results.add_value("meshes", names);
}

void add_mesh(const BodyOptions& body, const std::string& drawing, Info& info) {
  const Surface surface = read_body_mesh(body);
  const MeshInfo mesh = inspect_mesh(surface);
  info.findings.add(mesh.findings);
  info.warnings.insert(info.warnings.end(), mesh.warnings.begin(), mesh.warnings.end());
  if (drawing.empty()) return;
  write_defects(drawing, drawing_of(surface, mesh.defects));
  info.findings.add("drawing", drawing);
}

Info info_of_file(const InfoOptions& options) {
  Info info;
  info.findings.add("file", options.path);
  if (add_rig_alone(options, info.findings)) return info;
  if (holds_rig(options.path)) {
    const Rig rig = read_rig(options.path, {}).rig;
    add_rig_info(rig, options.radius, info.findings);
    info.warnings = rig.warnings;
  }
  if (!holds_mesh(options.path)) return info;
  BodyOptions body;
  if (is_scene(options.path)) {
    const Settings settings = with_fit(read_scene(options.path, options.overrides));
    add_scene(settings, info.findings);
    body = settings.body;
  } else {
    body = body_of_mesh(options);
    add_parts(options.path, info.findings);
  }
  if (!options.drawing.empty()) {
    refuse_output(options.drawing, {options.path, body.mesh});
    refuse_file_of_run(options.drawing);
  }
  add_mesh(body, options.drawing, info);
  info.findings.add_line("warnings", info.warnings.size());
  return info;
}

}  // namespace

Info info_of(const InfoOptions& options) {
  std::error_code unreachable;
  if (options.verify || std::filesystem::is_directory(options.path, unreachable))
    return info_of_run(options);
  return info_of_file(options);
}

}  // namespace sinew
