// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-render: pictures and a movie of a run, without ParaView.
#include <filesystem>
#include <memory>

#include <sinew/core/system.h>
#include <sinew/render/display.h>
#include <sinew/run/figure_set.h>
#include <sinew/run/run_record.h>
#include "command/command.h"
#include "command/results.h"

namespace {

using namespace sinew;

struct Options {
  std::string folder, other_folder, target, array, camera = "three_quarter", colors = "indigo";
  std::vector<std::string> views{"body"};
  std::vector<double> times, range;
  int width = 1280, height = 720;
  bool no_movie = false;
};

std::string help_of_views() {
  std::string text = "Comma-separated list of";
  for (const ViewPreset& preset : view_presets())
    ((text += preset.name == view_presets().front().name ? " " : ", ") += preset.name) +=
        " (" + std::string(preset.help) + ')';
  return text;
}

std::string help_of_colormap() {
  std::string text;
  for (const NamedColorMap& named : color_maps())
    (text += text.empty() ? "One of " : ", ") += named.name;
  return text;
}

void declare_what(OptionList& list, Options& options) {
  list.add("DIR", options.folder, "Folder of the run").required();
  list.add("--view", options.views, help_of_views()).comma_separated().type_name("NAMES");
  list.add("--compare", options.other_folder, "Another run, shown beside this one")
      .type_name("DIR");
  list.add("--times", options.times, "Times of the pictures, s; chosen by the motion if not given")
      .comma_separated()
      .type_name("T,T,...");
  list.add("--array", options.array,
           "Array shown in color: displacement, velocity, force_pair, strain, J, ...")
      .type_name("NAME");
  list.add_flag("--no-movie", options.no_movie, "Pictures only");
  list.add("-o", options.target, "Folder of the pictures, by default DIR/pictures");
}

void declare_how(OptionList& list, Options& options) {
  list.add("--range", options.range, "Values of the lowest and highest color")
      .comma_separated()
      .type_name("LOW,HIGH");
  list.add("--colormap", options.colors, help_of_colormap()).type_name("NAME").show_default();
  list.add("--camera", options.camera,
           "three_quarter, front, back, left, right, top, or the direction toward the viewer")
      .type_name("NAME or X,Y,Z")
      .show_default();
  list.add("--width", options.width, "Width of pictures and movie, pixels")
      .range(64, 8192)
      .show_default();
  list.add("--height", options.height, "Height of pictures and movie, pixels")
      .range(64, 8192)
      .show_default();
}

FigureSetOptions figure_set_options(const Options& options) {
  FigureSetOptions figure_set;
  figure_set.width = options.width;
  figure_set.height = options.height;
  figure_set.view = view_named(options.camera);
  figure_set.colors = color_map_named(options.colors);
  figure_set.times = options.times;
  if (options.range.empty()) return figure_set;
  if (options.range.size() != 2 || !(options.range[0] < options.range[1]))
    throw bad_input("a range of colors needs two numbers, the lower one first",
                    "give it as --range 0,0.5");
  figure_set.range = {options.range[0], options.range[1]};
  return figure_set;
}

Exit render(const Options& options, const Common& common) {
  FigureSetOptions figure_set = figure_set_options(options);
  std::vector<ViewPreset> presets;
  for (const std::string& view : options.views) presets.push_back(view_preset_named(view));
  ensure_display();
  Stopwatch watch;
  std::deque<DrawnRun> runs;
  std::vector<const DrawnRun*> shown;
  for (const std::string& folder : {options.folder, options.other_folder})
    if (!folder.empty())
      shown.push_back(
          &runs.emplace_back(folder, presets, options.array, figure_set.view, common.threads != 1));
  const RunFiles& run = runs.front().files();
  figure_set.folder =
      options.target.empty() ? run.folder.pictures() : std::filesystem::path(options.target);
  create({figure_set.folder});
  const PicturesLock lock(figure_set.folder);
  int pictures = 0;
  for (std::size_t preset = 0; preset < presets.size(); ++preset) {
    FigureSet pages(shown, preset, figure_set);
    pictures += pages.pictures() + 1;
    pages.sheet();
    if (!options.no_movie) pages.movie();
  }
  Results results;
  results.add("pictures", pictures);
  if (!options.no_movie) results.add("movie_frames", run.frames());
  record_stage(run.folder, "rendering", watch.lap());
  results.add("folder", figure_set.folder.string());
  results.print(common.json);
  return Exit::done;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  About about{"render",
              "Draws pictures and a movie of a run.",
              {"sinew render out/box_bend", "sinew render out/box_bend --width 1920 --height 1080",
               "sinew render out/box_bend --view strain,section --times 0,0.5,1 --no-movie",
               "sinew render out/box_bend --view forces --camera front --colormap inferno",
               "sinew render out/paper --compare out/bonded"}};
  about.takes_scene = false;
  return run_command(
      argc, argv, about,
      [&](OptionList& list) { declare_what(list, options), declare_how(list, options); },
      [&](const Common& common) { return render(options, common); });
}
