// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/new/new_scene.h>

#include <filesystem>

#include <sinew/core/error.h>
#include <sinew/core/file.h>
#include <sinew/mesh/mesh_formats.h>
#include <sinew/mesh/refine.h>
#include <sinew/scene/scene_files.h>

namespace sinew {
namespace {

void refuse_older(const std::filesystem::path& path, bool force) {
  if (std::filesystem::exists(path) && !force)
    throw bad_input(Place{path.string()}, "is there already",
                    "give another name with -o, or --force to replace it");
}

std::string scene_path(const NewSceneWish& wish) {
  std::filesystem::path path = wish.scene;
  if (path.empty()) path = std::filesystem::path(wish.mesh).stem().replace_extension(".yaml");
  if (!is_scene(path))
    throw bad_input("'" + path.string() + "' is no name for a scene",
                    "give a name that ends in .yaml");
  refuse_older(path, wish.force);
  return path.string();
}

/// Writes the mesh of a scene that has none in a file; `figure` is that of a rig alone.
void write_missing_mesh(const NewSceneWish& wish, NewSceneFiles& files, RigBody& figure) {
  const bool rig_alone = !wish.body && !wish.polygons && !holds_mesh(wish.mesh);
  if (!wish.body && !wish.polygons && !rig_alone) return;
  if (rig_alone && !wish.rig.empty())
    throw bad_input(Place{wish.mesh}, "is no mesh", "give the mesh first, then the rig");
  if (rig_alone) figure = body_of_rig(wish.mesh), files.rig = wish.mesh, files.figure = &figure;
  std::filesystem::path path = files.scene;
  path.replace_extension(wish.polygons ? ".ply" : ".obj");
  refuse_older(path, wish.force);
  files.mesh = path.string();
  write_file(path, wish.polygons ? ply_text(*wish.polygons)
                                 : obj_text(rig_alone ? figure.skin : *wish.body));
}

}  // namespace

WrittenScene write_new_scene(const NewSceneWish& wish) {
  NewSceneFiles files{wish.mesh, wish.rig, scene_path(wish)};
  files.up = wish.up, files.quick = wish.quick;
  files.clip = wish.clip, files.count = wish.count, files.duration = wish.duration;
  RigBody figure;
  write_missing_mesh(wish, files, figure);
  WrittenScene written{files.scene, "", new_scene(files)};
  const NewScene& scene = written.scene;
  for (const auto& [path, text] : scene.parts) refuse_older(path, wish.force);
  if (files.mesh != wish.mesh) written.mesh = files.mesh;
  if (!scene.mesh.empty()) {
    write_file(scene.mesh, scene.mesh_text);
    written.mesh = scene.mesh;
  }
  for (const auto& [path, text] : scene.parts) write_file(path, text);
  write_file(files.scene, scene.text);
  return written;
}

}  // namespace sinew
