// SPDX-License-Identifier: GPL-3.0-or-later
// Keeps a run from being lost: checkpoints now and then, and what --resume begins with.
#pragma once

#include <optional>
#include <string>

#include <sinew/core/system.h>
#include <sinew/io/checkpoint.h>
#include <sinew/run/frame_writer.h>
#include <sinew/run/run_folder.h>
#include <sinew/scene/setup.h>
#include <sinew/settings/settings.h>

namespace sinew {

/// Throws bad input, naming the first line that differs, when the run in the folder is of another
/// scene. What decides about no bit (checkpoints, wall time) may differ.
void check_same_scene(const RunFolder& folder, const std::string& resolved);

/// Of a setup with the body's skin at rest, under the resolved scene. What the scene's files hold
/// counts as well: meshes, rigs and clips may have changed under the same name.
RunIdentity identity_of(const std::string& resolved, const Setup& setup, const Triangles& surface);

class RunCheckpoints {
 public:
  RunCheckpoints(const RunFolder& folder, const Settings& settings);

  /// The state to go on with, if there is one. Throws bad input when it is another run's.
  std::optional<SimulationState> resume(const RunIdentity& run, std::string& complaint);
  void keep_for(const RunIdentity& run) { run_ = run; }

  bool due() const { return since_.seconds() >= interval_; }
  /// Whether the run has used up its time.
  bool out_of_time() const { return limit_ && begun_.seconds() >= *limit_; }
  /// Hands a checkpoint to the frame_writer, to be written after the frames before it.
  void save(const Simulation& simulation, FrameWriter& frame_writer);

 private:
  Checkpoints checkpoints_;
  RunIdentity run_;
  double interval_;              ///< s
  std::optional<double> limit_;  ///< s
  Stopwatch begun_, since_;
};

}  // namespace sinew
