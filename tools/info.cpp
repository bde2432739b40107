// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-info: the content of a mesh, rig, clip or scene, and its defects.
#include <nlohmann/json.hpp>

#include <sinew/inspection/info.h>
#include <sinew/scene/body_mesh.h>
#include <sinew/scene/rig.h>
#include <sinew/scene/scene_files.h>
#include "command/body_options.h"
#include "command/command.h"
#include "command/results.h"

namespace {

using namespace sinew;

Exit info(InfoOptions options, const BodyFlags& body, const Common& common) {
  options.overrides = common.overrides;
  for (const Override& one : body.overrides()) options.overrides.push_back(one);
  const Info info = info_of(options);
  Results results;
  results.add(info.findings);
  results.add_value("warnings", info.warnings);
  results.print(common);
  for (const std::string& warning : info.warnings) say(common, "sinew: warning: " + warning);
  if (info.damage) throw Error(*info.damage);
  return Exit::done;
}

}  // namespace

int main(int argc, char** argv) {
  InfoOptions options;
  BodyFlags body;
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
        body.declare(list, BodyFlags::Kind::mesh);
      },
      [&](const Common& common) { return info(options, body, common); });
}
