// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-render: pictures and a movie of a run, without ParaView.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "command.h"
#include "core/stopwatch.h"
#include "render/contact_sheet.h"
#include "render/display.h"
#include "render/movie.h"
#include "results.h"
#include "run_files.h"
#include "run_record.h"
#include "run_shot.h"

namespace {

using namespace sinew;

struct Options {
  std::string folder;
  int width = 1280, height = 720;
  bool no_movie = false;
};

void declare(CLI::App& app, Options& options) {
  app.add_option("DIR", options.folder, "Folder of the run")->required();
  app.add_option("--width", options.width, "Width of pictures and movie, pixels")
      ->check(CLI::Range(64, 8192))
      ->capture_default_str();
  app.add_option("--height", options.height, "Height of pictures and movie, pixels")
      ->check(CLI::Range(64, 8192))
      ->capture_default_str();
  app.add_flag("--no-movie", options.no_movie, "Pictures only");
}

/// What must be known of all frames before the first is drawn.
struct Story {
  std::vector<double> angle;  ///< per frame: largest turn of a bone since rest, rad
  ColourScale scale{"displacement", "m", 0, 0};
  Camera camera;  ///< sees the whole body at all times
};

double largest_turn(const RunFiles& run, const RunFrame& frame) {
  double most = 0;
  for (std::size_t b = 0; b < frame.bones.size(); ++b) {
    const Mat3 turn = frame.bones[b].rotation * run.skeleton.bones[b].rest.rotation.transpose();
    most = std::max(most, Eigen::AngleAxisd(turn).angle());
  }
  return most;
}

Story read_story(const RunFiles& run, int threads) {
  Story story;
  FramesInOrder frames(run, threads != 1);
  for (std::size_t i = 0; i < run.frames(); ++i) {
    RunFrame frame = frames.next();
    story.angle.push_back(largest_turn(run, frame));
    for (const double value : frame.displacement)
      story.scale.high = std::max(story.scale.high, value);
    story.camera.frame.extend(seen(story.camera.view, shot_of(run, std::move(frame), 0)));
  }
  if (!(story.scale.high > 0)) story.scale.high = run.body.particles.radius;  // nothing has moved
  return story;
}

/// The frames that tell the story: rest, half way, farthest (its last moment), and the end.
std::vector<std::size_t> telling_frames(const std::vector<double>& angle) {
  const double most = *std::max_element(angle.begin(), angle.end());
  std::size_t half = 0, farthest = 0;
  while (angle[half] < most / 2) ++half;
  for (std::size_t i = 0; i < angle.size(); ++i)
    if (angle[i] >= most * (1 - 1e-5)) farthest = i;
  std::vector<std::size_t> frames{0, half, farthest, angle.size() - 1};
  std::sort(frames.begin(), frames.end());
  frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
  return frames;
}

std::string numbered(std::size_t frame) {
  const std::string digits = std::to_string(frame);
  return "body_" + std::string(6 - std::min<std::size_t>(6, digits.size()), '0') + digits + ".png";
}

class Album {
 public:
  Album(const RunFiles& run, const Options& options, int threads)
      : run_(run),
        options_(options),
        story_(read_story(run, threads)),
        painter_(run.surface, story_.scale) {}

  /// The contact sheet, and each of its moments by itself. Returns how many pictures.
  int pictures() {
    std::vector<Shot> shots;
    for (const std::size_t frame : telling_frames(story_.angle)) {
      shots.push_back(shot(frame));
      PictureOptions picture;
      picture.camera = story_.camera;
      picture.width = options_.width;
      picture.height = options_.height;
      write_png(painter_.draw(shots.back(), picture), place(numbered(frame)));
    }
    write_png(contact_sheet(painter_, shots, {}), place("contact_sheet.png"));
    return static_cast<int>(shots.size()) + 1;
  }

  void movie() {
    MovieOptions movie;
    movie.width = options_.width & ~1;  // H.264 wants even sizes
    movie.height = options_.height & ~1;
    movie.frames_per_second = std::clamp(1 / run_.settings.output.interval, 0.1, 240.0);
    Movie film(place("movie.mp4"), movie);
    FrameOptions frame;
    frame.camera = story_.camera;
    frame.width = movie.width;
    frame.height = movie.height;
    for (std::size_t i = 0; i < run_.frames(); ++i) film.add(movie_frame(painter_, shot(i), frame));
    film.finish();
  }

 private:
  Shot shot(std::size_t frame) const {
    return shot_of(run_, read_frame(run_, frame), story_.angle[frame]);
  }
  std::string place(const std::string& name) const {
    return (run_.folder.pictures() / name).string();
  }

  const RunFiles& run_;
  Options options_;
  Story story_;
  Painter painter_;
};

Exit render(const Options& options, const Common& common) {
  Stopwatch watch;
  const RunFiles run = open_run({options.folder});
  create({run.folder.pictures()});
  Album album(run, options, common.threads);
  Results results;
  results.add("pictures", album.pictures());
  if (!options.no_movie) {
    album.movie();
    results.add("movie_frames", run.frames());
  }
  record_stage(run.folder, "rendering", watch.lap());
  results.add("folder", run.folder.pictures().string());
  results.print(common.json);
  return Exit::done;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  About about{
      "render",
      "Draws pictures and a movie of a run.",
      {"sinew render out/box_bend", "sinew render out/box_bend --width 1920 --height 1080"}};
  about.takes_scene = false;
  return run_command(
      argc, argv, about, [&](CLI::App& app) { declare(app, options); },
      [&](const Common& common) {
        ensure_display();
        return render(options, common);
      });
}
