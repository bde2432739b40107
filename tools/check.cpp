// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-check: the resources a run would need, and doubtful settings of its scene.

#include <optional>

#include <sinew/inspection/check.h>
#include <sinew/run/run_folder.h>
#include <sinew/scene/scene_files.h>
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

Exit check(const std::string& scene, const std::string& picture, int modes,
           const std::string& output, const Common& common) {
  refuse_mesh_as_scene(scene);
  if (!output.empty()) {
    refuse_output(output, {scene}, ".pvd");
    if (std::filesystem::exists(std::filesystem::path(output).parent_path() / "run.json"))
      throw bad_input(Place{output}, "would lie among the series of a run, and may replace one",
                      "name a file in another folder");
  }
  if (!picture.empty()) {
    refuse_output(picture, {scene}, ".png");
    refuse_file_of_run(picture);
    prepare_to_draw();
  }
  std::optional<Waiting> waiting(std::in_place, "preparing", progress_style(common.quiet));
  const Prepared prepared = prepare({read_scene(scene, common.overrides)});
  waiting.emplace("trying steps and modes", progress_style(common.quiet));
  const SceneCheck check = check_scene(prepared, run_folder(scene, "").path,
                                       modes > 0        ? modes
                                       : output.empty() ? 1
                                                        : 6);
  waiting.reset();
  Results results;
  results.add(check.findings);
  if (!output.empty()) {
    write_modes(prepared, check.shapes, output);
    results.add("shapes", output);
  }
  if (!picture.empty()) add_pictures(prepared, check.meeting, picture, results);
  results.add("warnings", check.warnings.size());
  results.print(common);
  for (const std::string& warning : check.warnings) print_error("sinew: warning: " + warning);
  return Exit::done;
}

}  // namespace

int main(int argc, char** argv) {
  std::string scene, picture, output;
  int modes = 0;
  return run_command(
      argc, argv,
      {"check",
       "Reports what a run needs, and doubtful settings of its scene.",
       {"sinew check configs/box_bend.yaml",
        "sinew check configs/box_bend.yaml --picture scene.png",
        "sinew check configs/box_bend.yaml --set body.radius=0.005",
        "sinew check configs/bar_pull.yaml --modes 6 -o modes.pvd"}},
      [&](OptionList& list) {
        list.add("SCENE", scene, "Scene file (YAML)").required();
        list.add("--picture", picture, "Draw the scene: its bones in its mesh, with axes in meters")
            .type_name("FILE.png");
        list.add("--modes", modes, "Number of the lowest elastic modes to list")
            .type_name("N")
            .range(1, 60);
        list.add("-o,--output", output,
                 "Write their shapes (6, unless --modes says otherwise) for ParaView, 12 frames of "
                 "a period")
            .type_name("FILE.pvd");
      },
      [&](const Common& common) { return check(scene, picture, modes, output, common); });
}
