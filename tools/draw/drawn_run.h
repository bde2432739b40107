// SPDX-License-Identifier: GPL-3.0-or-later
// A run as pictures need it: its moments as shots, and what must be known of all of them before the
// first is drawn.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "draw/drawn_values.h"
#include "draw/look.h"
#include "folder/run_files.h"
#include "render/shot.h"

namespace sinew {

/// What one look shows of a run.
struct DrawnLook {
  Look look;
  DrawnValues values;
  DrawnValues::Range range;  ///< over all frames
};

struct Story {
  std::vector<double> angle;  ///< per frame: largest turn of a bone since rest, rad
  Box frame;                  ///< of the whole body at all times, in the camera's directions
};

class DrawnRun {
 public:
  /// Reads all frames once. `array`: in colour instead of what each look shows by itself, or empty.
  /// Throws bad input.
  DrawnRun(const std::string& folder, const std::vector<Look>& looks, const std::string& array,
           const Mat3& view, bool ahead);
  DrawnRun(const DrawnRun&) = delete;
  DrawnRun& operator=(const DrawnRun&) = delete;

  const RunFiles& files() const { return run_; }
  const Story& story() const { return story_; }
  const std::vector<DrawnLook>& looks() const { return looks_; }
  std::string name() const;  ///< of its folder

  /// The frame nearest in time.
  std::size_t frame_at(double time) const;
  /// The frames that tell the story: rest, half way, farthest (its last moment), and the end.
  std::vector<std::size_t> telling_frames() const;

  Shot shot(std::size_t index, const DrawnLook& drawn) const;

 private:
  void read_story(const Mat3& view, bool ahead);
  void cut_open(Shot& shot) const;
  void add_arrows(Shot& shot, std::size_t index, const DrawnLook& drawn) const;

  RunFiles run_;
  Mat3 view_;
  std::vector<DrawnLook> looks_;
  Story story_;
};

}  // namespace sinew
