// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-new: a scene for a mesh, which runs as it is.
#include <filesystem>

#include <sinew/core/file.h>
#include <sinew/scene/body.h>
#include <sinew/scene/new_scene.h>
#include <sinew/scene/scene_files.h>
#include "command/command.h"
#include "command/results.h"

namespace {

using namespace sinew;

struct Options {
  NewSceneFiles files;
  bool force = false;
};

void declare(OptionList& list, Options& options) {
  list.add("MESH", options.files.mesh, "Mesh (" + mesh_formats() + ')').required();
  std::string rig("Skeleton and clip (");
  rig.append(rig_formats).append("); by default those of the mesh's file, or bones along limbs");
  list.add("RIG", options.files.rig, rig);
  list.add("-o", options.files.scene, "File of the scene; by default NAME-OF-MESH.yaml")
      .type_name("FILE");
  list.add_flag("--force", options.force, "Replace an older scene");
}

/// The scene's path, in the current directory by default.
std::string scene_path(const Options& options) {
  std::filesystem::path path = options.files.scene;
  if (path.empty())
    path = std::filesystem::path(options.files.mesh).stem().replace_extension(".yaml");
  if (!is_scene(path))
    throw bad_input("'" + path.string() + "' is no name for a scene",
                    "give a name that ends in .yaml");
  if (std::filesystem::exists(path) && !options.force)
    throw bad_input(Place{path.string()}, "is there already",
                    "give another name with -o, or --force to replace it");
  return path.string();
}

Exit make(Options options, const Common& common) {
  options.files.scene = scene_path(options);
  const NewScene scene = new_scene(options.files);
  if (!scene.mesh.empty()) write_file(scene.mesh, scene.mesh_text);
  write_file(options.files.scene, scene.text);
  Results results;
  results.add("scene", options.files.scene);
  if (!scene.mesh.empty()) results.add("mesh", scene.mesh);
  results.add("unit", scene.unit);
  results.add("up", scene.axes);
  results.add("bones", scene.bones);
  results.add("size", scene.size);
  results.add("run", "sinew run " + options.files.scene);
  results.print(common.json);
  return Exit::done;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  return run_command(
      argc, argv,
      {"new",
       "Writes a scene for a mesh, with bones and motion, which runs as it is.",
       {"sinew new part.stl", "sinew new body.obj walk.bvh -o walk.yaml", "sinew new fox.glb"},
       false},
      [&](OptionList& list) { declare(list, options); },
      [&](const Common& common) { return make(options, common); });
}
