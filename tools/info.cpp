// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-info: the content of a mesh, rig, clip or scene, and its defects.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include <sinew/analysis/time_step.h>
#include <sinew/core/particles.h>
#include <sinew/core/text.h>
#include <sinew/fill/fill_limits.h>
#include <sinew/fill/fill_warnings.h>
#include <sinew/io/checksums.h>
#include <sinew/io/single_files.h>
#include <sinew/repair/diagnosis.h>
#include <sinew/rig/motion.h>
#include <sinew/run/run_record.h>
#include <sinew/scene/body.h>
#include <sinew/scene/rig.h>
#include <sinew/settings/read_scene.h>
#include <sinew/settings/sections.h>

#include "command/body_options.h"
#include "command/command.h"
#include "command/results.h"

namespace {

using namespace sinew;

using Json = nlohmann::ordered_json;

constexpr int min_samples = 200;  // of a clip, for its largest speed

/// The largest speed of any bone's head or tail in a clip, m/s.
double largest_speed(const Skeleton& skeleton, const Clip& clip) {
  const int samples = std::max(min_samples, 2 * clip.frames);
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

/// The default time step of a body of the default material, s.
double usual_step(double radius) {
  const MaterialOptions settings;
  const Material material =
      make_material(settings, {radius, settings.density * volume_per_particle(radius)});
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
  if (!settings.bones.empty()) return add_rig_info({skeleton_of(settings), {}}, radius, results);
  Skeleton named;  // of the bones that a clip moves
  Json moves = Json::array();
  for (const TrackDefinition& track : settings.tracks) {
    if (std::find(moves.begin(), moves.end(), track.bone) != moves.end()) continue;
    named.bones.push_back({track.bone, no_bone, 1, {}});
    moves.push_back(track.bone);
  }
  const Clip clip = clip_of(motion_of(settings, named), name, settings.motion.frame_rate);
  results.add("tracks", clip.motion.tracks.size());
  add_clip_info({clip}, results);
  results.add("moves", moves);
}

nlohmann::ordered_json as_list(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

void add_counts(const Surface& surface, Results& results) {
  results.add("points", surface.triangles.points.size());
  results.add("triangles", surface.triangles.faces.size());
  results.add("components", surface.components);
  results.add("closed", surface.closed());
  results.add("holes", surface.border.holes);
  results.add("open_edges", surface.border.edges);
  results.add("border_length", surface.border.length, "m");
  results.add("crowded_edges", surface.border.crowded_edges);
}

void add_cleaning(const CleaningCounts& counts, Results& results) {
  for (const NamedCount& one : cleaning_counts())
    if (one.of != NamedCount::Of::repair || counts.*one.count > 0)
      results.add(std::string(one.name), counts.*one.count);
}

void add_radii(double inside, const Diagnosis& diagnosis, Results& results) {
  for (const int power : {3, 4, 5, 6}) {
    const double radius = radius_for_count(inside, std::pow(10, power));
    const std::string name = "1e" + std::to_string(power);
    results.add("radius_for_" + name, radius, "m");
    if (diagnosis.thinnest)
      results.add("thinnest_part_at_" + name, *diagnosis.thinnest / radius, "radii");
  }
  if (diagnosis.thinnest)
    results.add("radius_for_thinnest_part", *diagnosis.thinnest / surely_filled_thickness(1), "m");
}

/// One number per face: its worst defect.
std::int32_t face_defect(const Defects& defects, std::size_t face) {
  if (defects.flat[face]) return 6;
  if (!defects.intersecting.empty() && defects.intersecting[face]) return 5;
  return defects.turned[face] ? 4 : 0;
}

DefectsFile drawing_of(const Surface& surface, const Defects& defects) {
  DefectsFile file;
  file.surface = surface.triangles;
  for (std::size_t i = 0; i < surface.triangles.faces.size(); ++i)
    file.defect.push_back(face_defect(defects, i));
  file.component.assign(surface.component.begin(), surface.component.end());
  file.hole.assign(file.defect.size(), -1);
  for (const DefectiveEdge& edge : defects.edges) {
    file.edges.push_back({edge.a, edge.b});
    file.defect.push_back(1 + static_cast<int>(edge.defect));
    file.component.push_back(-1);
    file.hole.push_back(edge.hole);
  }
  return file;
}

std::vector<std::string> mesh_warnings(const Surface& surface, double ambiguous, double inside) {
  std::vector<std::string> warnings;
  if (!surface.warning.empty()) warnings.push_back(surface.warning);
  const double size = bounds(surface.triangles.points).sizes().maxCoeff();
  if (const auto odd = size_warning(size)) warnings.push_back(*odd);
  if (ambiguous > max_ambiguous)
    warnings.push_back("the surface has no inside (" + three_digits(100 * ambiguous) +
                       " % of its box is ambiguous): close its holes, or fill it with a thickness");
  else if (!(inside > 0))
    warnings.push_back("the surface encloses no volume: fill it with a thickness");
  return warnings;
}

std::vector<std::string> add_mesh_info(const BodyOptions& body, const std::string& drawing,
                                       Results& results) {
  const Surface surface = read_body_mesh(body);
  const Diagnosis diagnosis = diagnose(surface);
  const double ambiguous = ambiguous_fraction(surface), inside = volume_inside(surface);
  add_counts(surface, results);
  results.add("self_intersections", diagnosis.intersections.pairs,
              diagnosis.intersections.complete ? "" : "at least");
  add_cleaning(surface.cleaning, results);
  results.add("volume", inside, surface.closed() ? "m^3" : "m^3, about");
  results.add("area", area(surface.triangles), "m^2");
  const Box box = bounds(surface.triangles.points);
  results.add("box_low", as_list(box.min()), "m");
  results.add("box_size", as_list(box.sizes()), "m");
  results.add("ambiguous_share", ambiguous);
  if (diagnosis.thinnest) results.add("thinnest_part", *diagnosis.thinnest, "m");
  if (ambiguous <= max_ambiguous && inside > 0) add_radii(inside, diagnosis, results);
  if (!drawing.empty()) {
    write_defects(drawing, drawing_of(surface, defects_of(surface, diagnosis)));
    results.add("drawing", drawing);
  }
  return mesh_warnings(surface, ambiguous, inside);
}

struct Options {
  std::string path, drawing;
  BodyFlags body;
  std::optional<double> radius;
  bool verify = false;
};

void add_verified(const RunFolder& folder, Results& results, VerifiedFiles& files) {
  files = verify_checksums(folder.path);
  results.add("verified", files.files);
  for (const std::string& name : files.damaged) results.add_line("damaged", name);
  for (const std::string& name : files.missing) results.add_line("missing", name);
  results.add_value("damaged", files.damaged);
  results.add_value("missing", files.missing);
}

Exit describe_run(const Options& options, const Common& common) {
  const RunFolder folder{options.path};
  if (!folder.used())
    throw bad_input(Place{options.path}, "is not the folder of a run",
                    "give a file, or the folder that sinew run or sinew simulate writes");
  const auto record = read_record(folder);
  Results results;
  results.add("folder", options.path);
  for (const char* key : {"version", "status", "started", "particles", "bones", "frames", "steps",
                          "time_step", "duration"})
    if (const auto value = record.find(key); value != record.end())
      results.add(key, value->is_array() ? nlohmann::ordered_json(value->size()) : *value);
  VerifiedFiles files;
  if (options.verify) add_verified(folder, results, files);
  results.print(common);
  const std::size_t wrong = files.damaged.size() + files.missing.size();
  if (wrong == 0) return Exit::done;
  throw bad_input(Place{options.path},
                  std::to_string(wrong) + " of " + std::to_string(files.files) +
                      " files are damaged or missing",
                  "restore them from a copy, or run the scene again with --force");
}

void add_scene(const Settings& settings, Results& results) {
  SceneRig scene = rig_of(settings, read_rig_files(settings));
  results.add("mesh", settings.body.mesh);
  results.add("tracks", scene.motion.tracks.size());
  Clip clip = clip_of(std::move(scene.motion), "scene", settings.motion.frame_rate);
  add_rig_info({std::move(scene.skeleton), {std::move(clip)}}, settings.body.radius, results);
}

BodyOptions body_of_mesh(const Options& options, const Common& common) {
  std::vector<Override> overrides = common.overrides;
  for (const Override& one : options.body.overrides()) overrides.push_back(one);
  overrides.push_back({"body.count", "1000", "--count 1000"});  // not used, but required of a body
  return settings_of_mesh(options.path, overrides).body;
}

/// Whether the file is a rig or clip in YAML, without anything else.
bool add_rig_alone(const Options& options, Results& results) {
  if (!is_scene(options.path)) return false;
  const auto alone = read_rig_alone(options.path);
  if (!alone) return false;
  const std::string name = std::filesystem::path(options.path).stem().string();
  add_rig_alone_info(*alone, name, options.radius, results);
  return true;
}

Exit print(Results& results, const std::vector<std::string>& warnings, const Common& common) {
  results.add_value("warnings", warnings);
  results.print(common);
  for (const std::string& warning : warnings) say(common, "sinew: warning: " + warning);
  return Exit::done;
}

Exit info(const Options& options, const Common& common) {
  std::error_code unreachable;
  if (options.verify || std::filesystem::is_directory(options.path, unreachable))
    return describe_run(options, common);
  Results results;
  results.add("file", options.path);
  if (add_rig_alone(options, results)) {
    results.print(common);
    return Exit::done;
  }
  std::vector<std::string> warnings;
  if (holds_rig(options.path)) {
    const Rig rig = read_rig(options.path, {}).rig;
    add_rig_info(rig, options.radius, results);
    warnings = rig.warnings;
  }
  if (!holds_mesh(options.path)) return print(results, warnings, common);
  BodyOptions body;
  if (is_scene(options.path)) {
    const Settings settings = with_fit(read_scene(options.path, common.overrides));
    add_scene(settings, results);
    body = settings.body;
  } else {
    body = body_of_mesh(options, common);
  }
  if (!options.drawing.empty()) refuse_output(options.drawing, {options.path, body.mesh});
  for (std::string& warning : add_mesh_info(body, options.drawing, results))
    warnings.push_back(std::move(warning));
  results.add_line("warnings", warnings);
  return print(results, warnings, common);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  return run_command(
      argc, argv,
      {"info",
       "Describes a mesh, rig, clip, scene or run and lists its defects.",
       {"sinew info data/meshes/box.obj", "sinew info part.stl --unit mm -o defects.vtu",
        "sinew info configs/box_bend.yaml", "sinew info data/motions/walk.bvh --radius 0.01",
        "sinew info out/box_bend --verify"}},
      [&](OptionList& list) {
        list.add("FILE", options.path,
                 "Mesh (" + mesh_formats() + "), rig (" + rig_formats +
                     "), scene, rig or clip (YAML), or the folder of a run")
            .required();
        list.add("-o", options.drawing, "Draw the mesh with its defects, for ParaView")
            .type_name("FILE.vtu");
        list.add("--radius", options.radius,
                 "Radius of particles, m: report how fast the rig would move them")
            .positive();
        list.add_flag("--verify", options.verify,
                      "Compare all files of a run with their checksums; names damaged ones");
        options.body.declare(list, BodyFlags::Kind::mesh);
      },
      [&](const Common& common) { return info(options, common); });
}
