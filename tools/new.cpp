// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-new: a scene for a mesh, which runs as it is.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include <sinew/core/file.h>
#include <sinew/core/text.h>
#include <sinew/io/gltf/geometry.h>
#include <sinew/mesh/refine.h>
#include <sinew/mesh/solids.h>
#include <sinew/scene/body_mesh.h>
#include <sinew/scene/new/new_scene.h>
#include <sinew/scene/new/new_study.h>
#include <sinew/scene/rig.h>
#include <sinew/scene/scene_files.h>
#include <sinew/settings/read_scene.h>
#include <sinew/settings/text_file.h>
#include "command/command.h"
#include "command/progress.h"
#include "command/results.h"

namespace {

using namespace sinew;

struct Options {
  NewSceneWish wish;
  std::string shape;
  std::string size = "0.1,0.1,0.4";
  std::string up;
  std::string meshes;
  std::string studied;  ///< scene for which a study is written
  double duration = 0;
  int count = 0;
};

void declare(OptionList& list, Options& options) {
  list.add("MESH", options.wish.mesh,
           "Mesh (" + mesh_formats() + "); or a rig alone, which gets a skin");
  std::string rig("Skeleton and clip (");
  rig.append(rig_formats).append("); by default those of the mesh's file, or bones along limbs");
  list.add("RIG", options.wish.rig, rig);
  list.add("-o", options.wish.scene, "File of the scene; by default NAME-OF-MESH.yaml")
      .type_name("FILE");
  list.add("--shape", options.shape, "A body without a mesh: " + listed(solid_names))
      .type_name("SHAPE");
  list.add("--size", options.size, "Its sides along x, y, z in meters")
      .type_name("X,Y,Z")
      .show_default();
  list.add("--up", options.up, "Axis of the mesh that points up: y or z; by default a guess")
      .type_name("AXIS");
  list.add("--meshes", options.meshes,
           "Meshes of the file, as sinew info lists them; others are left out")
      .type_name("NAME,...");
  list.add("--clip", options.wish.clip,
           "Clip by its name; by default a walk, or the first that moves bones")
      .type_name("NAME");
  list.add("--count", options.count, "Particles; by default as many as a run of minutes may take")
      .positive()
      .type_name("N");
  list.add("--duration", options.duration, "Seconds; by default the clip, 3 s of it at most")
      .positive()
      .type_name("S");
  list.add_flag("--quick", options.wish.quick,
                "A scene that runs in ten seconds or so: few particles and pictures, 2 s at most");
  list.add("--study", options.studied, "Write a study of this scene for sinew sweep instead")
      .type_name("SCENE.yaml");
  list.add_flag("--force", options.wish.force, "Replace an older scene");
}

Vec3 size_of(const std::string& text) {
  Vec3 size = Vec3::Zero();
  char rest = 0;
  const int read =
      std::sscanf(text.c_str(), "%lf,%lf,%lf%c", &size.x(), &size.y(), &size.z(), &rest);
  if (read != 3 || !(size.minCoeff() > 0) || !(size.maxCoeff() < 1e6))
    throw bad_input("--size " + shown(text) + " is no size",
                    "give three lengths above 0 in meters, as in 0.1,0.1,0.4");
  constexpr double longest = 500;  // extent of what is filled and meshed in seconds
  if (size.maxCoeff() > longest * size.minCoeff())
    throw bad_input("--size " + shown(text) + " is over 500 times as long as thin",
                    "make it shorter or thicker");
  return size;
}

std::optional<Axis> up_of(const std::string& word) {
  if (word.empty()) return std::nullopt;
  if (word == "y") return Axis::y;
  if (word == "z") return Axis::z;
  throw bad_input("--up " + shown(word) + " is no axis of meshes", "give y or z");
}

Triangles solid_of(const Options& options) {
  const auto found = std::find(solid_names.begin(), solid_names.end(), options.shape);
  if (found == solid_names.end())
    throw bad_input("unknown shape " + shown(options.shape),
                    suggestion(options.shape, solid_names));
  const Vec3 size = size_of(options.size);
  return refined(solid(static_cast<SolidShape>(found - solid_names.begin()), size),
                 size.minCoeff() / 4);
}

/// Takes some meshes of a file of several, and its rig.
void choose_meshes(const std::string& names, NewSceneWish& wish) {
  if (!is_gltf(wish.mesh))
    throw bad_input("--meshes is of files with named meshes", "leave it out, or give a glTF file");
  std::vector<std::string> chosen;
  std::istringstream text(names);
  for (std::string name; std::getline(text, name, ',');) chosen.push_back(name);
  wish.polygons = read_gltf_meshes(wish.mesh, chosen);
  if (!wish.up) wish.up = Axis::y;
  if (wish.rig.empty() && holds_rig(wish.mesh)) wish.rig = wish.mesh;
}

/// Beside the scene, which it names.
Exit make_study(const Options& options, const Common& common) {
  namespace fs = std::filesystem;
  if (!options.wish.mesh.empty() || !options.shape.empty())
    throw bad_input("--study is of a scene, not of a mesh", "leave out the mesh");
  const fs::path scene = options.studied;
  const Settings settings = read_scene(scene);
  fs::path study = options.wish.scene;
  if (study.empty()) study = scene.parent_path() / (scene.stem().string() + "_study.yaml");
  if (fs::exists(study) && !options.wish.force)
    throw bad_input(Place{study.string()}, "is there already",
                    "replace it with --force, or name another file with -o");
  write_file(study, new_study(path_in(study.parent_path(), scene.string()), settings));
  Results results;
  results.add("study", study.string());
  results.add("run", "sinew sweep " + shell_quoted(study.string()));
  results.print(common);
  return Exit::done;
}

Exit make(Options options, const Common& common) {
  if (!options.studied.empty()) return make_study(options, common);
  if (options.shape.empty() == options.wish.mesh.empty())
    throw bad_input("a scene needs a mesh or a shape",
                    "give MESH, or --shape; see sinew new --help");
  if (!options.shape.empty()) {
    options.wish.body = solid_of(options);
    options.wish.mesh = options.shape;
  }
  options.wish.up = up_of(options.up);
  if (!options.meshes.empty()) choose_meshes(options.meshes, options.wish);
  if (options.count > 0) options.wish.count = options.count;
  if (options.duration > 0) options.wish.duration = options.duration;
  const WrittenScene written = [&] {
    const Waiting waiting("looking at the mesh", progress_style(common.quiet));
    return write_new_scene(options.wish);
  }();
  const NewScene& scene = written.scene;
  Results results;
  results.add("scene", written.path);
  if (!scene.mesh.empty()) results.add("mesh", scene.mesh);
  results.add("unit", scene.unit);
  results.add("up", scene.axes);
  if (!scene.holes.empty()) results.add("holes", scene.holes);
  if (!scene.materials.empty()) results.add("materials", scene.materials);
  results.add("bones", scene.bones);
  if (!scene.pose.empty()) results.add("rest", scene.pose);
  results.add("size", scene.size);
  if (!scene.time.empty()) results.add("time", scene.time);
  results.add("run", "sinew run " + shell_quoted(written.path));
  results.print(common);
  if (!scene.warning.empty()) say(common, "sinew: warning: " + scene.warning);
  return Exit::done;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  return run_command(
      argc, argv,
      {"new",
       "Writes a scene for a mesh, with bones and motion, which runs as it is.",
       {"sinew new part.stl", "sinew new body.obj walk.bvh -o walk.yaml", "sinew new fox.glb",
        "sinew new body.obj walk.bvh --quick", "sinew new --study bend.yaml",
        "sinew new --shape capsule --size 0.1,0.1,0.5"},
       false},
      [&](OptionList& list) { declare(list, options); },
      [&](const Common& common) { return make(options, common); });
}
