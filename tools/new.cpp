// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-new: a scene for a mesh, which runs as it is.
#include <algorithm>
#include <cstdio>

#include <sinew/core/text.h>
#include <sinew/mesh/refine.h>
#include <sinew/mesh/solids.h>
#include <sinew/scene/body_mesh.h>
#include <sinew/scene/new/new_scene.h>
#include <sinew/scene/rig.h>
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

Exit make(Options options, const Common& common) {
  if (options.shape.empty() == options.wish.mesh.empty())
    throw bad_input("a scene needs a mesh or a shape",
                    "give MESH, or --shape; see sinew new --help");
  if (!options.shape.empty()) {
    options.wish.body = solid_of(options);
    options.wish.mesh = options.shape;
  }
  options.wish.up = up_of(options.up);
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
  results.add("bones", scene.bones);
  if (!scene.pose.empty()) results.add("rest", scene.pose);
  results.add("size", scene.size);
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
        "sinew new --shape capsule --size 0.1,0.1,0.5"},
       false},
      [&](OptionList& list) { declare(list, options); },
      [&](const Common& common) { return make(options, common); });
}
