// SPDX-License-Identifier: GPL-3.0-or-later
// A scene from its file to a finished run: filled, bound, stepped, every frame written, checkpoints
// kept. What `sinew simulate` does, for programs:
//
//     const Settings scene = read_scene("configs/box_bend.yaml");
//     const RunResult result = simulate(scene, {"out/box_bend"});
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include <sinew/core/error.h>
#include <sinew/run/engine_steps.h>
#include <sinew/run/run_folder.h>
#include <sinew/settings/settings.h>

namespace sinew {

/// How far a run is.
struct RunProgress {
  int frame = 0, frames = 0;  ///< the last one is number `frames`
  double time = 0;            ///< time of the scene, s
  std::int64_t steps = 0;
  double waited = 0;  ///< s that stepping has waited for the disk
  /// On the way to the next equilibrium, every thousand; 0: a frame has been written.
  std::int64_t iterations = 0;
  double residual = 0;  ///< residual by then
};

struct SimulateOptions {
  bool force = false;                            ///< replace an older run in the folder
  bool resume = false;                           ///< continue a run that was stopped
  std::vector<std::string> command = {"sinew"};  ///< how the run was started, for its record

  std::optional<Engine> engine = {};  ///< program that makes the steps; none: this one

  // What a caller may listen to; each may be empty.
  std::function<void(const RunProgress&)> progress = {};
  std::function<void(const std::string&)> message = {};
  std::function<void(const std::string&)> warning = {};
  std::function<bool()> stop_requested = {};  ///< asked after every step
  std::function<void()> before_writing = {};  ///< once the scene is prepared
};

struct RunResult {
  Exit exit = Exit::done;     ///< done, or interrupted: resumable with SimulateOptions::resume
  bool was_finished = false;  ///< resumed, and there was nothing left to do
  std::string record;         ///< run.json
};

/// Throws bad input, naming the scene's line, for what the scene gets wrong, for a folder that
/// holds another run or another sinew works in; unstable, with the last sound state in blowup.vtu;
/// not written. A run that stops in any way leaves its frames and can be resumed. Meshes that the
/// scene holds are written to meshes/*.ply, which the written scene names.
RunResult simulate(const Settings& scene, const RunFolder& folder,
                   const SimulateOptions& options = {});

}  // namespace sinew
