// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-info: what is in a mesh, a rig, a clip or a scene, and what is wrong with it.
#include "command/command.h"
#include <sinew/settings/read_rig.h>
#include <sinew/settings/read_scene.h>
#include "info/mesh_info.h"
#include "info/rig_info.h"
#include <sinew/rig/motion.h>
#include <sinew/scene/body.h>
#include "command/body_options.h"
#include <sinew/scene/rig.h>

namespace {

using namespace sinew;

struct Options {
  std::string path, drawing;
  BodyFlags body;
  std::optional<double> radius;
};

void add_scene(const Settings& settings, Results& results) {
  SceneRig scene = rig_of(settings);
  results.add("mesh", settings.body.mesh);
  results.add("tracks", scene.motion.tracks.size());
  Clip clip = clip_of(std::move(scene.motion), "scene", settings.motion.frame_rate);
  add_rig_info({std::move(scene.skeleton), {std::move(clip)}}, settings.body.radius, results);
}

BodyOptions body_of_mesh(const Options& options, const Common& common) {
  std::vector<Override> overrides = common.overrides;
  for (const Override& one : options.body.overrides()) overrides.push_back(one);
  overrides.push_back({"body.count", "1000", "--count 1000"});  // not used, but a body needs one
  return settings_of_mesh(options.path, overrides).body;
}

/// Whether the file was a rig or a clip of YAML, which holds nothing else.
bool add_rig_alone(const Options& options, Results& results) {
  if (!is_scene(options.path)) return false;
  const auto alone = read_rig_alone(options.path);
  if (!alone) return false;
  const std::string name = std::filesystem::path(options.path).stem().string();
  add_rig_alone_info(*alone, name, options.radius, results);
  return true;
}

Exit info(const Options& options, const Common& common) {
  Results results;
  results.add("file", options.path);
  if (add_rig_alone(options, results)) {
    results.print(common.json);
    return Exit::done;
  }
  if (holds_rig(options.path)) add_rig_info(read_rig(options.path, {}), options.radius, results);
  if (!holds_mesh(options.path)) {
    results.print(common.json);
    return Exit::done;
  }
  BodyFlags body;
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
       "Describes a mesh, rig, clip or scene and lists its defects.",
       {"sinew info data/meshes/box.obj", "sinew info part.stl --unit mm -o defects.vtu",
        "sinew info configs/box_bend.yaml", "sinew info data/motions/walk.bvh --radius 0.01"}},
      [&](CLI::App& app) {
        app.add_option("FILE", options.path,
                       "Mesh (" + mesh_formats() + "), rig (" + rig_formats +
                           ") or scene, rig or clip (YAML)")
            ->required();
        app.add_option("-o", options.drawing, "Draw the mesh with its defects, for ParaView")
            ->type_name("FILE.vtu");
        app.add_option("--radius", options.radius,
                       "Radius of particles, m: report how fast the rig would move them")
            ->check(CLI::PositiveNumber);
        options.body.declare(app, BodyOptions::Kind::mesh);
      },
      [&](const Common& common) { return info(options, common); });
}
