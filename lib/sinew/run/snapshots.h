// SPDX-License-Identifier: GPL-3.0-or-later
// A frame of a run as a picture shows it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <sinew/metrics/rest_body.h>
#include <sinew/render/snapshot.h>
#include <sinew/run/run_files.h>
#include <sinew/run/view_presets.h>

namespace sinew {

/// `angle`: what the caption says of the bones, rad. Bones are as long as they are in the frame.
Snapshot snapshot_of(const RunFiles& run, RunFrame frame, double angle);

// The quantities of particles that pictures show in color: those a run has written, and those that
// are measured from its frames.

class DrawnValues {
 public:
  /// `name`: an array of the particles, or strain, stretch, J, D2min, von_mises, speed. Throws bad
  /// input for others, with the nearest.
  DrawnValues(const RunFiles& run, const std::string& name);

  const std::string& name() const { return name_; }
  const std::string& unit() const { return unit_; }  ///< empty for pure numbers

  /// One per particle in the written order; of vectors the magnitude. `frame` is the run's frame of
  /// that index.
  std::vector<double> at(std::size_t index, const RunFrame& frame) const;

  /// What stands at the ends of the colors for these values: their range without the hundredth
  /// part at each end, which few stray particles have to themselves; from zero where that is near.
  struct Range {
    double low = 0, high = 0;
  };
  static Range range_of(std::vector<double> values);

 private:
  std::vector<double> measured(const RunFrame& frame) const;

  const RunFiles* run_;
  std::string name_, unit_;
  int components_ = 1;
  std::shared_ptr<const RestBody> rest_;  ///< for what is measured
};

/// An array of vectors at the particles of a frame. Throws bad input when the run has none of that
/// name.
Points drawn_vectors(const RunFiles& run, std::size_t index, const std::string& name);

// A run as pictures need it: its moments as snapshots, and what must be known of all of them before
// the first is drawn.

/// What one preset shows of a run.
struct DrawnView {
  ViewPreset preset;
  DrawnValues values;
  DrawnValues::Range range;  ///< over all frames
};

struct Story {
  std::vector<double> angle;  ///< per frame: largest turn of a bone since rest, rad
  Box frame;                  ///< of the whole body at all times, in the camera's directions
};

class DrawnRun {
 public:
  /// Reads all frames once. `array`: in color instead of what each preset shows by itself, or
  /// empty. Throws bad input.
  DrawnRun(const std::string& folder, const std::vector<ViewPreset>& presets,
           const std::string& array, const Mat3& view, bool ahead);
  DrawnRun(const DrawnRun&) = delete;
  DrawnRun& operator=(const DrawnRun&) = delete;

  const RunFiles& files() const { return run_; }
  const Story& story() const { return story_; }
  const std::vector<DrawnView>& view_presets() const { return views_; }
  std::string name() const;  ///< of its folder

  /// The frame nearest in time.
  std::size_t frame_at(double time) const;
  /// The frames that tell the story: rest, half way, farthest (its last moment), and the end.
  std::vector<std::size_t> telling_frames() const;

  Snapshot snapshot(std::size_t index, const DrawnView& drawn) const;

 private:
  void read_story(const Mat3& view, bool ahead);
  void cut_open(Snapshot& snapshot) const;
  void add_arrows(Snapshot& snapshot, std::size_t index, const DrawnView& drawn) const;

  RunFiles run_;
  Mat3 view_;
  std::vector<DrawnView> views_;
  Story story_;
};

}  // namespace sinew
