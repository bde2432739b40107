// SPDX-License-Identifier: GPL-3.0-or-later
// The run of a simulation that a program steps: frames of the moments that it chooses, in a folder
// that all who read runs can open.
//
//     SteppedRun run({"out/mine"}, prepared, simulation);
//     for (...) simulation.advance(10), run.add(simulation);
//     run.end();
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <sinew/run/frame_writer.h>
#include <sinew/run/run_folder.h>
#include <sinew/scene/prepare.h>
#include <sinew/settings/settings.h>
#include <sinew/stepping/simulation.h>

namespace sinew {

class RunLog;

/// How the folder begins.
struct SteppedRunOptions {
  bool force = false;                            ///< replace an older run in the folder
  std::vector<std::string> command = {"sinew"};  ///< for its record
};

class SteppedRun {
 public:
  /// `prepared`: what the simulation was started from, which must outlive this. Throws bad input
  /// for a folder that holds another run or other files, or in which another sinew works.
  SteppedRun(const RunFolder& folder, const Prepared& prepared, const Simulation& simulation,
             const SteppedRunOptions& options = {});
  /// Ends the run as stopped, unless it has been ended.
  ~SteppedRun();
  SteppedRun(const SteppedRun&) = delete;
  SteppedRun& operator=(const SteppedRun&) = delete;

  const RunFolder& folder() const { return folder_; }
  int frames() const { return frames_; }  ///< frames so far

  /// Adds a frame of the present moment. Throws bad input for one that is not later than the last,
  /// not written.
  void add(Simulation& simulation);
  /// Waits until all is written, and closes the record: "finished".
  void end() { close("finished"); }

 private:
  void close(const std::string& status);

  RunFolder folder_;
  const Simulation& simulation_;
  std::optional<FolderLock> lock_;
  std::unique_ptr<RunLog> log_;
  std::optional<FrameWriter> writer_;
  int frames_ = 0;
  double last_ = 0;  ///< time of the last frame, s
};

}  // namespace sinew
