// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-render: pictures and a movie of a run, without ParaView.
#include <algorithm>
#include <cmath>
#include <deque>
#include <filesystem>
#include <memory>
#include <sstream>

#include <sinew/core/file.h>
#include <sinew/core/system.h>
#include <sinew/core/threads.h>
#include <sinew/display/display.h>
#include <sinew/figures/figure_set.h>
#include <sinew/figures/scene_picture.h>
#include <sinew/figures/small_pictures.h>
#include <sinew/run/run_record.h>
#include "command/child.h"
#include "command/command.h"
#include "command/progress.h"
#include "command/results.h"

namespace {

using namespace sinew;

struct Options {
  std::string folder, other_folder, target, array, camera = "three_quarter", colors = "indigo";
  std::string look = "screen", background;
  std::vector<std::string> bones;
  std::vector<int> traced;
  double orbit = 0;  ///< degrees
  bool axes = false;
  std::vector<std::string> views;  ///< none given: the body, and bonds where the run wrote them
  std::vector<double> times, range, plane;
  std::vector<int> part;      ///< part of the movie's frames, which goes to standard output: K of N
  int width = 0, height = 0;  ///< 0: those of the look
  bool no_movie = false, no_pictures = false;
  std::string small;      ///< file that lists runs: a small picture of each
  bool percents = false;  ///< whether progress is told as lines on standard output, for sinew run
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

std::string help_of_colors() {
  std::string text;
  for (const NamedColor& named : named_colors()) (text += text.empty() ? "" : ", ") += named.name;
  return text;
}

std::string help_of_looks() {
  std::string text;
  for (const Look& look : looks())
    ((text += text.empty() ? "" : "; ") += look.name) += " (" + std::string(look.help) + ')';
  return text;
}

void declare_what(OptionList& list, Options& options) {
  const CommandOption small = list.add("--small", options.small).group("");
  list.add("DIR", options.folder, "Folder of the run").excludes(small);
  list.add("--view", options.views, help_of_views()).comma_separated().type_name("NAMES");
  list.add("--compare", options.other_folder, "Another run, shown beside this one")
      .type_name("DIR");
  list.add("--times", options.times, "Times of the pictures, s; chosen by the motion if not given")
      .comma_separated()
      .type_name("T,T,...");
  list.add("--array", options.array,
           "Array shown in color, also on the skin: displacement, velocity, force_pair, strain, J, "
           "...")
      .type_name("NAME");
  list.add(
          "--plane", options.plane,
          "Plane of the views cut and forces: a point, and the direction toward the part left out; "
          "by default through the joint that turns most")
      .comma_separated()
      .type_name("X,Y,Z,NX,NY,NZ");
  list.add(
          "--bones", options.bones,
          "Bones by name: these alone are drawn; particles of other bones are gray, without arrows")
      .comma_separated()
      .type_name("NAME,NAME,...");
  list.add("--trace", options.traced, "Particles by id, whose paths up to each moment are drawn")
      .comma_separated()
      .type_name("ID,ID,...");
  list.add_flag("--no-movie", options.no_movie, "Pictures only");
  list.add_flag("--no-pictures", options.no_pictures, "Movie only");
  list.add("--part", options.part).comma_separated().expected(2).group("");
  list.add_flag("--percents", options.percents, "").group("");
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
  list.add("--orbit", options.orbit,
           "Angle by which the camera turns in the movie about the body's upright axis, degrees")
      .type_name("DEGREES");
  list.add("--look", options.look, help_of_looks()).type_name("NAME").show_default();
  list.add("--background", options.background,
           help_of_colors() +
               ", #rrggbb, or transparent (pictures only); by default that of the look")
      .type_name("COLOR");
  list.add_flag("--axes", options.axes, "The directions of X, Y and Z in a corner");
  list.add("--width", options.width, "Width of pictures and movie, pixels, by default 1280")
      .range(64, 8192);
  list.add("--height", options.height, "Height of pictures and movie, pixels, by default 720")
      .range(64, 8192);
}

void check_movie(const Options& options, const Backdrop& backdrop) {
  if (backdrop.transparent && !options.no_movie)
    throw bad_input("a movie has no transparent background",
                    "add --no-movie, or name a color: --background white");
  if (!std::isfinite(options.orbit))
    throw bad_input("an orbit needs a number of degrees", "give one: --orbit 360");
  if (options.orbit != 0 && options.no_movie)
    throw bad_input("the camera orbits in the movie alone", "leave out --no-movie or --orbit");
}

/// The view binding, whose colors have no range, where others are drawn in one.
void leave_out_without_range(DrawnRunOptions& what, const Options& options, const Common& common) {
  if (options.range.empty() || what.presets.size() < 2) return;
  if (std::erase_if(what.presets, [](const ViewPreset& one) { return one.view == View::binding; }))
    say(common, "warning: without the view binding: its colors have no range");
}

FigureSetOptions figure_set_options(const Options& options) {
  FigureSetOptions figure_set;
  const Look& look = look_named(options.look);
  figure_set.width = options.width > 0 ? options.width : look.width;
  figure_set.height = options.height > 0 ? options.height : look.height;
  figure_set.view = view_named(options.camera);
  figure_set.colors = color_map_named(options.colors);
  figure_set.times = options.times;
  figure_set.files.backdrop = backdrop_named(
      options.background.empty() ? std::string(look.background) : options.background);
  figure_set.files.print_width = look.print_width;
  figure_set.axes = options.axes;
  figure_set.orbit = radians(options.orbit);
  check_movie(options, figure_set.files.backdrop);
  if (!options.range.empty()) figure_set.range = color_range(options.range);
  return figure_set;
}

std::optional<CutPlane> plane_of(const Options& options) {
  if (options.plane.empty()) return std::nullopt;
  const auto& p = options.plane;
  const auto finite = [](double value) { return std::isfinite(value); };
  if (p.size() != 6 || !std::all_of(p.begin(), p.end(), finite) || Vec3(p[3], p[4], p[5]).isZero(0))
    throw bad_input("a plane needs six numbers: a point on it, and a direction that is not zero",
                    "give it as --plane 0,0,0.3,0,-1,0");
  return CutPlane{{p[0], p[1], p[2]}, Vec3(p[3], p[4], p[5]).normalized()};
}

/// Other processes that draw their parts of the movie at the same time, as one has one display.
class Helpers {
 public:
  /// With the words of this command.
  Helpers(int count, const std::vector<std::string>& words) {
    for (int k = 1; k <= count; ++k) {
      std::vector<std::string> with_part = {"--part",
                                            std::to_string(k) + ',' + std::to_string(count + 1)};
      with_part.insert(with_part.end(), words.begin(), words.end());
      helpers_.push_back(std::make_unique<Helper>("render", with_part));
    }
  }

  /// Frames as they draw them; a helper that fails is replaced by `pages`.
  std::vector<FrameSource> sources(FigureSet& pages) {
    std::vector<FrameSource> sources;
    for (auto& helper : helpers_)
      sources.push_back([&helper, &pages](std::size_t frame) {
        const MovieOptions movie = pages.movie_options();
        Image image(movie.width, movie.height);
        if (helper && helper->read(image.rgb)) return image;
        helper.reset();
        return pages.movie_frame(frame);
      });
    return sources;
  }

 private:
  std::vector<std::unique_ptr<Helper>> helpers_;
};

/// Each reads the run for itself: of large ones there is but one.
int helpers_for(const RunFiles& run, const Options& options) {
  constexpr std::size_t large = 2'000'000;
  constexpr int most = 3;
  if (options.no_movie || run.body.particles.size() > large) return 0;
  return std::min(threads_allowed() - 1, most);
}

/// A part of the movies' frames, as bytes.
void write_part(FigureSet& pages, const std::vector<int>& part) {
  for (int frame = part[0]; frame < static_cast<int>(pages.movie_frames()); frame += part[1]) {
    const Image image = pages.movie_frame(static_cast<std::size_t>(frame));
    print_out({reinterpret_cast<const char*>(image.rgb.data()), image.rgb.size()});
  }
}

/// Tells what fraction of the pictures is drawn.
class DrawnFraction {
 public:
  DrawnFraction(const Options& options, const Common& common, std::size_t pictures)
      : lines_(options.percents),
        pictures_(pictures),
        progress_("drawing", progress_style(common.quiet)) {}

  void add_one() {
    const std::size_t before = 100 * drawn_ / pictures_;
    ++drawn_;
    if (!lines_) return progress_.at(drawn_, pictures_);
    if (100 * drawn_ / pictures_ > before)
      print_out("percent " + std::to_string(100 * drawn_ / pictures_) + '\n');
  }

 private:
  bool lines_;
  std::size_t drawn_ = 0, pictures_;
  StageProgress progress_;
};

/// Counts pictures of one view, frames of the movie too.
std::size_t pictures_planned(const Options& options, const DrawnRun& run) {
  const std::size_t moments =
      options.times.empty() ? run.key_moments().size() : options.times.size();
  return (options.no_pictures ? 0 : moments) + (options.no_movie ? 0 : run.files().frames());
}

std::vector<std::string> views_of(const Options& options) {
  if (!options.views.empty()) return options.views;
  std::vector<std::string> views = {"body"};
  const bool bonds = std::filesystem::exists(std::filesystem::path(options.folder) / "bonds.pvd");
  if (bonds && !options.no_pictures && options.array.empty() && options.other_folder.empty())
    views.push_back("bonds");
  return views;
}

/// Whether the pictures are those of a whole run, which begin with its scene.
bool tells_all(const Options& options) {
  return !options.no_pictures && options.views.empty() && options.times.empty() &&
         options.other_folder.empty();
}

/// Returns whether a view has one: of those that were not asked for, the first alone.
bool has_movie(const Options& options, std::size_t view) {
  return !options.no_movie && (view == 0 || !options.views.empty());
}

std::filesystem::path target_of(const Options& options, const RunFiles& run) {
  if (options.target.empty()) return run.folder.pictures();
  if (std::filesystem::weakly_canonical(options.target) !=
      std::filesystem::weakly_canonical(run.folder.pictures()))
    refuse_file_of_run(std::filesystem::path(options.target) / "contact_sheet.png");
  return options.target;
}

/// Opens a run for what can be drawn of it; the rest is told, and left out of `what`.
const DrawnRun& opened(std::deque<DrawnRun>& runs, const std::string& folder, DrawnRunOptions& what,
                       const Common& common) {
  const DrawnRun& run = runs.emplace_back(folder, what);
  for (const auto& [preset, why] : run.left_out()) {
    say(common, "warning: without the view " + preset + ": " + why);
    std::erase_if(what.presets, [&](const ViewPreset& one) { return one.name == preset; });
  }
  return run;
}

/// One view or several of a run, or of two.
std::vector<const DrawnRun*> open_runs(std::deque<DrawnRun>& runs, const Options& options,
                                       DrawnRunOptions& what, const Common& common) {
  std::vector<const DrawnRun*> shown = {&opened(runs, options.folder, what, common)};
  if (options.other_folder.empty()) return shown;
  shown.push_back(&opened(runs, options.other_folder, what, common));
  if (runs[0].view_presets().size() == what.presets.size()) return shown;
  runs.clear();  // the first once more, with what can be drawn of both
  return open_runs(runs, options, what, common);
}

DrawnRunOptions what_to_draw(const Options& options, const Mat3& view, const Common& common) {
  DrawnRunOptions what{{}, options.array, view, options.bones, options.traced, plane_of(options)};
  for (const std::string& name : views_of(options)) what.presets.push_back(view_preset_named(name));
  leave_out_without_range(what, options, common);
  what.ahead = common.threads != 1;
  what.follows = options.other_folder.empty();
  what.by_front = what.follows && is_side(options.camera);
  return what;
}

/// Ranges of the colors: those of runs beside each other hold the values of all.
ValueRanges ranges_of(const std::vector<const DrawnRun*>& shown) {
  ValueRanges ranges;
  for (const DrawnRun* run : shown)
    for (const auto& [quantity, found] : run->ranges()) {
      ValueRange& range = ranges.try_emplace(quantity, found).first->second;
      range = {std::min(range.low, found.low), std::max(range.high, found.high)};
    }
  return ranges;
}

/// Records and prints what has been drawn.
void tell(const Options& options, const Common& common, const std::vector<const DrawnRun*>& shown,
          int pictures, double seconds, const std::string& folder) {
  const DrawnRun& run = *shown.front();
  Results results;
  if (!options.no_pictures) results.add("pictures", pictures);
  if (!options.no_movie) results.add("movie_frames", run.files().frames());
  record_stage(run.files().folder, "rendering", seconds, {run.ranges(), run.files().frames_run});
  if (!options.no_pictures) renew_view(run.files().folder, run.files().ranges);
  if (!options.no_pictures) results.add_value("ranges", json_of(ranges_of(shown)));
  std::vector<std::string> left_out = views_of(options);
  for (const DrawnView& drawn : run.view_presets())
    std::erase(left_out, std::string(drawn.preset.name));
  if (!left_out.empty()) results.add("left_out", left_out);
  results.add("folder", folder);
  results.print(common);
}

/// The runs of a sweep.
Exit render_small(const std::string& list) {
  constexpr int width = 320, height = 240;
  constexpr std::uint64_t largest = std::uint64_t{1} << 26;
  std::vector<std::filesystem::path> runs;
  std::istringstream lines(read_file(list, largest));
  for (std::string line; std::getline(lines, line);) runs.emplace_back(line);
  ensure_display();
  write_small_pictures(runs, width, height);
  return Exit::done;
}

Exit render(const Options& options, Common common, const std::vector<std::string>& words) {
  if (!options.small.empty()) return render_small(options.small);
  if (options.folder.empty())
    throw bad_input("there is no DIR", "name the folder of a run: sinew render out/box_bend");
  if (!options.part.empty()) common.quiet = true;  // the main process tells all
  FigureSetOptions figure_set = figure_set_options(options);
  DrawnRunOptions what = what_to_draw(options, figure_set.view, common);
  ensure_display();
  Stopwatch watch;
  std::deque<DrawnRun> runs;
  const std::vector<const DrawnRun*> shown = open_runs(runs, options, what, common);
  const std::size_t views = what.presets.size();
  const RunFiles& run = runs.front().files();
  figure_set.view = runs.front().view();
  figure_set.folder = target_of(options, run);
  if (!options.part.empty()) {
    for (std::size_t preset = 0; preset < views; ++preset) {
      FigureSet pages(shown, preset, figure_set);
      if (has_movie(options, preset)) write_part(pages, options.part);
    }
    return Exit::done;
  }
  if (options.target.empty())
    create_inner_folder(figure_set.folder);
  else
    create_folder(figure_set.folder);
  const PicturesLock lock(figure_set.folder);
  Helpers helpers(helpers_for(run, options), words);
  DrawnFraction drawn(options, common, views * pictures_planned(options, runs.front()));
  figure_set.drawn = [&] { drawn.add_one(); };
  int pictures = 0;
  for (std::size_t preset = 0; preset < views; ++preset) {
    FigureSet pages(shown, preset, figure_set);
    if (!options.no_pictures) {
      pictures += pages.pictures() + 1;
      pages.sheet();
    }
    if (has_movie(options, preset)) pages.movie(helpers.sources(pages));
  }
  if (tells_all(options)) {
    write_scene_picture(scene_snapshot(run), {figure_set.width, figure_set.height},
                        figure_set.files, (figure_set.folder / "scene.png").string());
    ++pictures;
  }
  tell(options, common, shown, pictures, watch.lap(), figure_set.folder.string());
  return Exit::done;
}

}  // namespace

int main(int argc, char** argv) {
  keep_freed_memory();
  Options options;
  About about{"render",
              "Draws pictures and a movie of a run.",
              {"sinew render out/box_bend", "sinew render out/box_bend --view cut,lines --no-movie",
               "sinew render out/box_bend --width 1920 --height 1080",
               "sinew render out/box_bend --view strain,section --times 0,0.5,1 --no-movie",
               "sinew render out/box_bend --view surface,halves --array strain_eq",
               "sinew render out/box_bend --view forces --camera front --colormap inferno",
               "sinew render out/box_bend --view bonds --array force --axes --background black",
               "sinew render out/box_bend --orbit 360 --trace 0,100 --bones upper",
               "sinew render out/paper --compare out/bonded"}};
  about.takes_scene = false;
  return run_command(
      argc, argv, about,
      [&](OptionList& list) { declare_what(list, options), declare_how(list, options); },
      [&](const Common& common) {
        return render(options, common, std::vector<std::string>(argv + 1, argv + argc));
      });
}
