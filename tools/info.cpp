// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-info: what is in a mesh or a scene, and what is wrong with it.
#include "body_options.h"
#include "command.h"
#include "config/scene.h"
#include "mesh_info.h"
#include "mesh_input.h"
#include "rig/motion.h"
#include "scene_body.h"

namespace {

using namespace sinew;

struct Options {
  std::string path, drawing;
  BodyOptions body;
};

void add_scene(const Settings& settings, Results& results) {
  const Skeleton skeleton = make_skeleton(settings);
  const Motion motion = make_motion(settings, skeleton);
  results.add("mesh", settings.body.mesh);
  results.add("bones", skeleton.size());
  for (const Bone& bone : skeleton.bones)
    results.add("bone_" + bone.name, bone.length,
                bone.parent == no_bone ? "m" : "m, on " + skeleton.bones[bone.parent].name);
  results.add("tracks", motion.tracks.size());
  results.add("duration", last_key(motion), "s");
}

BodySettings body_of_mesh(const Options& options, const Common& common) {
  std::vector<Override> overrides = common.overrides;
  for (const Override& one : options.body.overrides()) overrides.push_back(one);
  overrides.push_back({"body.count", "1000", "--count 1000"});  // not used, but a body needs one
  return settings_of_mesh(options.path, overrides).body;
}

Exit info(const Options& options, const Common& common) {
  Results results;
  results.add("file", options.path);
  BodySettings body;
  if (is_scene(options.path)) {
    const Settings settings = read_scene(options.path, common.overrides);
    add_scene(settings, results);
    body = settings.body;
  } else {
    body = body_of_mesh(options, common);
  }
  if (!options.drawing.empty()) refuse_output(options.drawing, {options.path, body.mesh});
  const auto warnings = add_mesh_info(body, options.drawing, results);
  results.add("warnings", warnings);
  results.print(common.json);
  for (const std::string& warning : warnings) say(common, "sinew: warning: " + warning);
  return Exit::done;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  return run_command(
      argc, argv,
      {"info",
       "Says what is in a mesh or a scene, and what is wrong with it.",
       {"sinew info data/meshes/box.obj", "sinew info part.stl --unit mm -o defects.vtu",
        "sinew info configs/box_bend.yaml"}},
      [&](CLI::App& app) {
        app.add_option("FILE", options.path,
                       std::string("Mesh (").append(mesh_formats) + ") or scene (YAML)")
            ->required();
        app.add_option("-o", options.drawing, "Draw the mesh with its defects, for ParaView")
            ->type_name("FILE.vtu");
        options.body.declare(app, BodyOptions::Kind::mesh);
      },
      [&](const Common& common) { return info(options, common); });
}
