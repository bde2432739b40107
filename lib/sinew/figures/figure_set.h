// SPDX-License-Identifier: GPL-3.0-or-later
// The pictures and movies of one run, or of two side by side, in a folder.
//
//     FigureSet figures({&run}, 0, {.folder = "out/bend/pictures"});
//     figures.pictures();
#pragma once

#include <array>
#include <deque>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <sinew/figures/snapshots.h>
#include <sinew/render/figure.h>
#include <sinew/render/movie.h>

namespace sinew {

struct FigureSetOptions {
  std::filesystem::path folder;  ///< folder of the pictures
  int width = 1280, height = 720;
  Mat3 view = three_quarter_view();
  ColorMap colors = ColorMap::indigo;
  PageFiles files;
  bool axes = false;  ///< the scene's, in a corner
  double orbit = 0;   ///< turn of the camera over the movie, about the body's upright axis, rad
  std::optional<ValueRange> range;      ///< range of the colors; by default the run's own
  std::vector<double> times;            ///< s; empty: the run's key frames
  std::function<void()> drawn = [] {};  ///< called after each picture and frame of a movie
};

/// Throws bad input where pictures of this size take more than `available` bytes.
void check_memory(int width, int height, double available);

/// A picture of the movie's size.
using FrameSource = std::function<Image(std::size_t frame)>;

/// One view preset of one run or two, in the same colors and to the same scale.
class FigureSet {
 public:
  /// `preset`: index of the runs' view preset. The runs must outlive this object. Throws bad input
  /// for times outside the first run and for pictures that exceed the memory.
  FigureSet(std::vector<const DrawnRun*> runs, std::size_t preset, FigureSetOptions options);

  int pictures();  ///< one for each moment; returns their number
  void sheet();    ///< all moments in one picture; of the body as in the paper's figure 4
  /// Draws all frames (of the body, its surface beside its particles), in turn with `others`: frame
  /// i by the one of number i modulo their count, this one first.
  void movie(std::span<const FrameSource> others = {});
  std::size_t movie_frames() const;
  MovieOptions movie_options() const;
  Image movie_frame(std::size_t frame);

 private:
  const DrawnView& drawn(std::size_t run) const { return runs_[run]->view_presets()[preset_]; }
  std::string arrow_scale(std::size_t run) const;
  ColorScale scale() const;
  std::vector<KeyMoment> moments() const;
  std::vector<Snapshot> snapshots(std::size_t frame) const;
  const std::vector<std::vector<Snapshot>>& at_moments();
  bool particles_are_small(const SheetOptions& sheet) const;
  std::vector<Snapshot> cut_open() const;
  Camera movie_camera(std::size_t frame) const;
  std::vector<Panel> panels(const std::vector<Snapshot>& snapshots);
  FigureOptions figure_options(Finish finish) const;
  std::string title(std::size_t run) const;
  std::string words_of(const KeyMoment& moment) const;
  std::string row_title(std::size_t run) const;
  std::string name() const;
  std::string place(const std::string& file) const { return (options_.folder / file).string(); }
  bool of_body() const { return runs_.size() == 1 && drawn(0).preset.name == "body"; }

  std::vector<const DrawnRun*> runs_;
  std::size_t preset_;
  FigureSetOptions options_;
  std::deque<Painter> painters_;  ///< one for each run
  std::vector<std::vector<Snapshot>> at_moments_;
};

}  // namespace sinew
