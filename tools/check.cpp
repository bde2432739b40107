// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-check: the resources a run would need, and doubtful settings of its scene.

#include <optional>

#include <sinew/inspection/check.h>
#include <sinew/run/run_folder.h>
#include <sinew/scene/body.h>
#include <sinew/settings/read_scene.h>
#include "command/command.h"
#include "command/drawing.h"
#include "command/progress.h"
#include "command/results.h"
#if SINEW_DRAWS
#include <sinew/display/display.h>
#include <sinew/figures/scene_picture.h>
#endif

namespace {

using namespace sinew;

#if SINEW_DRAWS
void prepare_to_draw() { ensure_display(); }
void draw(const Prepared& prepared, const std::string& picture) {
  write_scene_picture(scene_snapshot(prepared), {}, {}, picture);
}
void draw(const Prepared& prepared, const Intrusion& found, const std::string& picture) {
  write_scene_picture(intrusion_snapshot(prepared, found), {}, {}, picture);
}
#else
void prepare_to_draw() { throw draws_nothing(); }
void draw(const Prepared&, const std::string&) {}
void draw(const Prepared&, const Intrusion&, const std::string&) {}
#endif

/// Draws the scene, and beside scene.png in scene_meets.png where flesh is deepest in flesh.
void add_pictures(const Prepared& prepared, const std::vector<Intrusion>& meeting,
                  const std::string& picture, Results& results) {
  draw(prepared, picture);
  results.add("picture", picture);
  if (meeting.empty()) return;
  std::filesystem::path path = picture;
  path.replace_filename(path.stem().string() + "_meets.png");
  draw(prepared, meeting.front(), path.string());
  results.add("picture_of_meeting", path.string());
}

Exit check(const std::string& scene, const std::string& picture, const Common& common) {
  refuse_mesh_as_scene(scene);
  if (!picture.empty()) {
    refuse_output(picture, {scene}, ".png");
    prepare_to_draw();
  }
  std::optional<Waiting> waiting(std::in_place, "preparing", progress_style(common.quiet));
  const Prepared prepared = prepare({read_scene(scene, common.overrides)});
  waiting.emplace("trying steps and modes", progress_style(common.quiet));
  const SceneCheck check = check_scene(prepared, run_folder(scene, "").path);
  waiting.reset();
  Results results;
  results.add(check.findings);
  if (!picture.empty()) add_pictures(prepared, check.meeting, picture, results);
  results.add("warnings", check.warnings.size());
  results.print(common);
  for (const std::string& warning : check.warnings) print_error("sinew: warning: " + warning);
  return Exit::done;
}

}  // namespace

int main(int argc, char** argv) {
  std::string scene, picture;
  return run_command(
      argc, argv,
      {"check",
       "Reports what a run needs, and doubtful settings of its scene.",
       {"sinew check configs/box_bend.yaml",
        "sinew check configs/box_bend.yaml --picture scene.png",
        "sinew check configs/box_bend.yaml --set body.radius=0.005"}},
      [&](OptionList& list) {
        list.add("SCENE", scene, "Scene file (YAML)").required();
        list.add("--picture", picture, "Draw the scene: its bones in its mesh, with axes in meters")
            .type_name("FILE.png");
      },
      [&](const Common& common) { return check(scene, picture, common); });
}
