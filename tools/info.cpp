// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-info: what is in a mesh or a scene, and what is wrong with it.
#include <algorithm>
#include <cmath>

#include "command.h"
#include "config/scene.h"
#include "fill/pack.h"
#include "mesh/read_surface.h"
#include "results.h"
#include "rig/motion.h"
#include "scene_body.h"

namespace {

using namespace sinew;

nlohmann::ordered_json as_list(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

void add_mesh(const std::string& path, Results& results) {
  const Surface surface = read_surface(path);
  const double enclosed = volume(surface.triangles);
  results.add("points", surface.triangles.points.size());
  results.add("triangles", surface.triangles.faces.size());
  results.add("bodies", surface.bodies);
  results.add("cavities", surface.cavities);
  results.add("closed", true);  // read_surface refuses everything else, with the reason
  results.add("faces_turned", surface.cleaning.faces_turned);
  results.add("points_merged", surface.cleaning.points_merged);
  results.add("volume", enclosed, "m^3");
  results.add("area", area(surface.triangles), "m^2");
  results.add("box_size", as_list(bounds(surface.triangles.points).sizes()), "m");
  for (const double count : {1e3, 1e4, 1e5, 1e6})
    results.add("radius_for_1e" + std::to_string(static_cast<int>(std::lround(std::log10(count)))),
                radius_for_count(enclosed, count), "m");
}

double duration_of(const Motion& motion) {
  double last = 0;
  for (const Track& track : motion.tracks) last = std::max(last, track.keys.back().time);
  return last;
}

void add_scene(const std::string& path, const Common& common, Results& results) {
  const Settings settings = read_scene(path, common.overrides);
  const Skeleton skeleton = make_skeleton(settings);
  const Motion motion = make_motion(settings, skeleton);
  results.add("mesh", settings.body.mesh);
  results.add("bones", skeleton.size());
  for (const Bone& bone : skeleton.bones)
    results.add("bone_" + bone.name, bone.length,
                bone.parent == no_bone ? "m" : "m, on " + skeleton.bones[bone.parent].name);
  results.add("tracks", motion.tracks.size());
  results.add("duration", duration_of(motion), "s");
  add_mesh(settings.body.mesh, results);
}

Exit info(const std::string& path, const Common& common) {
  Results results;
  results.add("file", path);
  if (is_scene(path))
    add_scene(path, common, results);
  else
    add_mesh(path, results);
  results.print(common.json);
  return Exit::done;
}

}  // namespace

int main(int argc, char** argv) {
  std::string path;
  return run_command(
      argc, argv,
      {"info",
       "Says what is in a mesh or a scene, and what is wrong with it.",
       {"sinew info data/meshes/box.obj", "sinew info configs/box_bend.yaml"}},
      [&](CLI::App& app) {
        app.add_option("FILE", path, "Mesh (OBJ, OFF, STL, PLY) or scene (YAML)")->required();
      },
      [&](const Common& common) { return info(path, common); });
}
