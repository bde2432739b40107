// SPDX-License-Identifier: GPL-3.0-or-later
// Writes checkpoints at intervals while a run proceeds, and restores the state for --resume.
//
//     RunCheckpoints checkpoints(folder, settings);
//     if (checkpoints.due()) checkpoints.save([&] { return simulation.save(); }, frame_writer);
#pragma once

#include <functional>
#include <optional>
#include <string>

#include <sinew/core/system.h>
#include <sinew/io/checkpoint.h>
#include <sinew/run/frame_writer.h>
#include <sinew/run/run_folder.h>
#include <sinew/scene/prepare.h>
#include <sinew/settings/settings.h>

namespace sinew {

/// Throws bad input, naming the first line that differs, when the run in the folder is of another
/// scene. Settings that do not affect the result (checkpoints, wall time) may differ.
void check_same_scene(const RunFolder& folder, const std::string& resolved);

/// Identity of a prepared scene with the body's skin at rest and the resolved scene. Includes the
/// content of the scene's files: meshes, rigs and clips may have changed under the same name.
RunIdentity identity_of(const std::string& resolved, const Prepared& prepared);

/// Throws bad input where meshes, rigs or clips have changed since the run in the folder was run.
void check_same_files(const RunFolder& folder, const RunIdentity& run);

class RunCheckpoints {
 public:
  RunCheckpoints(const RunFolder& folder, const Settings& settings);

  /// The state to continue from, if there is one. Throws bad input when it is another run's.
  std::optional<SimulationState> resume(const RunIdentity& run, std::string& complaint);
  void keep_for(const RunIdentity& run) { run_ = run; }

  bool due() const { return since_.seconds() >= interval_; }
  /// Whether the run has used up its wall time.
  bool out_of_time() const { return limit_ && begun_.seconds() >= *limit_; }
  /// Hands a checkpoint of the state to the frame writer, which writes it after the earlier frames.
  void save(const std::function<SimulationState()>& state, FrameWriter& frame_writer);

 private:
  Checkpoints checkpoints_;
  RunIdentity run_;
  double interval_;              ///< s
  std::optional<double> limit_;  ///< s
  Stopwatch begun_, since_;
};

}  // namespace sinew
