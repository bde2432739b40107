// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/scene_files.h>

#include <utility>

#include <sinew/core/error.h>
#include <sinew/core/file.h>
#include <sinew/core/text.h>
#include <sinew/io/gltf/geometry.h>
#include <sinew/io/gltf/rig.h>
#include <sinew/rig/bvh/bvh.h>
#include <sinew/rig/key_table.h>
#include <sinew/rig/retarget.h>
#include <sinew/scene/body_mesh.h>
#include <sinew/scene/context.h>

namespace sinew {
namespace {

bool is_bvh(const std::filesystem::path& path) {
  return lower(path.extension().string()) == ".bvh";
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

SkinnedRig read_if_named(const Settings& settings, const char* key, const std::string& path) {
  if (path.empty()) return {};
  return with_context(settings, key, [&] { return read_rig(path, settings.motion); });
}

/// The clips for the bones of a skeleton, by the scene's table of names.
Rig renamed(Rig rig, const Skeleton& skeleton, const Settings& settings) {
  Rig own{skeleton, {}, std::move(rig.warnings)};
  for (const Clip& clip : rig.clips) {
    if (!settings.motion.clip.empty() && clip.name != settings.motion.clip) continue;
    Retargeted made = retargeted(rig.skeleton, clip, skeleton, settings.motion.names);
    if (own.clips.empty())
      own.warnings.insert(own.warnings.end(), made.warnings.begin(), made.warnings.end());
    own.clips.push_back(clip);
    own.clips.back().motion = std::move(made.motion);
  }
  if (own.clips.empty() && !rig.clips.empty()) find_clip(rig.clips, settings.motion.clip);
  return own;
}

/// Clips of glTF files move the nodes of a glTF skeleton, others its bones.
Rig read_motion(const Settings& settings, const Skeleton& of_file) {
  const std::string &skeleton = settings.skeleton.file, &motion = settings.motion.file;
  if (is_key_table(motion)) return {};
  if (!motion.empty() && !settings.motion.names.empty()) {
    Rig rig = read_if_named(settings, "motion.file", motion).rig;
    return at_keys(settings, "motion.", [&] {
      return renamed(std::move(rig), skeleton.empty() ? make_skeleton(settings.bones) : of_file,
                     settings);
    });
  }
  if (motion.empty() || motion == skeleton || !is_gltf(motion) || !is_gltf(skeleton))
    return read_if_named(settings, "motion.file", motion).rig;
  return with_context(settings, "motion.file", [&] { return read_gltf_clips(skeleton, motion); });
}

/// Nothing for an obstacle of another shape.
Surface read_obstacle(const Settings& settings, std::size_t index) {
  const ObstacleSettings& obstacle = settings.world.obstacles[index];
  if (obstacle.shape != ObstacleShape::mesh) return {};
  BodyOptions file;
  file.mesh = obstacle.mesh;
  file.unit = settings.body.unit;
  file.scale = settings.body.scale;
  const std::string key = "world.obstacles[" + std::to_string(index) + "].mesh";
  return with_context(settings, key.c_str(), [&] { return read_body_mesh(file, settings); });
}

}  // namespace

bool holds_rig(const std::filesystem::path& path) {
  return is_bvh(path) || (is_gltf(path) && has_gltf_rig(path));
}

bool holds_mesh(const std::filesystem::path& path) {
  return !is_bvh(path) && !(is_gltf(path) && gltf_mesh_names(path).empty() && has_gltf_rig(path));
}

bool is_key_table(const std::filesystem::path& path) {
  return lower(path.extension().string()) == ".csv";
}

bool is_scene(const std::filesystem::path& path) {
  return path.extension() == ".yaml" || path.extension() == ".yml";
}

void refuse_mesh_as_scene(const std::string& path) {
  if (is_mesh(path))
    throw bad_input({path}, "this is a mesh, not a scene",
                    "make a scene of it: sinew new " + shell_quoted(path));
  if (is_bvh(path))
    throw bad_input({path}, "this is a rig, not a scene",
                    "make a scene of it and a mesh: sinew new MESH " + shell_quoted(path));
}

void refuse_to_replace_scene(const std::filesystem::path& output) {
  std::error_code missing;
  if (is_scene(output) && std::filesystem::exists(output, missing))
    throw bad_input(Place{output.string()}, "is a scene, and would be replaced",
                    "give another name with -o");
}

void refuse_output(const std::string& output, std::initializer_list<std::string> inputs,
                   const std::string& extension) {
  if (std::filesystem::path(output).extension() != extension)
    throw bad_input("'" + output + "' is no name for a " + extension + " file",
                    "give a name that ends in " + extension);
  std::error_code missing;
  for (const std::string& input : inputs)
    if (std::filesystem::equivalent(output, input, missing))
      throw bad_input(Place{output}, "is an input, and would be replaced",
                      "give another name with -o");
  refuse_to_replace_scene(output);
}

SkinnedRig read_rig(const std::filesystem::path& path, const MotionOptions& motion) {
  if (is_bvh(path)) return {read_bvh_rig(path, motion), {}, {}};
  if (is_gltf(path)) return read_gltf_rig(path);
  throw bad_input(Place{path.string()}, "is no rig that can be read",
                  std::string("give a file of YAML, ") + rig_formats);
}

SceneFiles read_rig_files(const Settings& settings) {
  SceneFiles files;
  files.skeleton = read_if_named(settings, "skeleton.file", settings.skeleton.file);
  files.motion = read_motion(settings, files.skeleton.rig.skeleton);
  if (const std::string& keys = settings.motion.file; is_key_table(keys))
    files.keys = with_context(settings, "motion.file", [&] {
      constexpr std::uint64_t largest = 1 << 30;  // bytes, hours of many bones
      return tracks_of_keys(read_file(keys, largest), keys);
    });
  return files;
}

SceneFiles read_files(const Settings& settings) {
  SceneFiles files = read_rig_files(settings);
  for (std::size_t i = 0; i < settings.world.obstacles.size(); ++i)
    files.obstacles.push_back(read_obstacle(settings, i));
  return files;
}

}  // namespace sinew
