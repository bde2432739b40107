// SPDX-License-Identifier: GPL-3.0-or-later
// Logs a run as it proceeds: run.json for programs, log.txt for people.
//
//     RunLog log(folder, {"sinew", "simulate", "scene.yaml"});
//     log.spend("setup", seconds);
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include <sinew/core/file.h>
#include <sinew/io/checkpoint.h>
#include <sinew/run/engine_steps.h>
#include <sinew/run/probe_table.h>
#include <sinew/run/run_folder.h>
#include <sinew/scene/prepare.h>
#include <sinew/scene/steps.h>
#include <sinew/settings/settings.h>
#include <sinew/stepping/frame_guard.h>

namespace sinew {

class RunLog {
 public:
  /// Begins both files with status "running"; those of a resumed run are continued. Throws not
  /// written.
  RunLog(const RunFolder& folder, const std::vector<std::string>& command, bool resumed = false);

  void describe(const Prepared& prepared);
  void describe(const RunIdentity& run);
  /// Describes the engine that makes the steps in another program.
  void describe(const Engine& engine);

  void describe(const EngineSteps& steps);  ///< how evenly its ranks share the particles

  /// Adds to "warnings", the shortest first, what is not yet there.
  void warn(const std::string& what);
  /// Adds to the seconds of a stage.
  void spend(const std::string& stage, double seconds);
  /// Writes run.json with the progress of the run. Throws not written.
  void checkpoint(std::int64_t steps);
  void frame(int frame, double time);
  void retake(const Retake& why);
  /// How the body came to rest in a frame.
  void load_step(int frame, const Equilibrium& found, const Unbalanced& left);
  /// Sets the number of frames, where a failure has left fewer than were begun.
  void frames(int written);

  /// Describes the steps of frames that were taken anew, and the speeds that were limited.
  void describe(const GuardState& guard, const LimitedSpeeds& limited);
  /// Describes what the last frame shows of Young's modulus.
  void describe(const std::vector<ShownModulus>& moduli);
  /// Writes run.json with the results of `simulation`. Throws not written.
  void end(const std::string& status, const Simulation& simulation);
  /// Records the end of a run that threw, as far as the disk permits.
  void fail(const std::string& status, const std::string& why);

  const nlohmann::ordered_json& record() const { return record_; }

 private:
  void describe(const StepperChoice& choice);
  void describe(const StepPlan& plan, int frames);
  void describe(const Grouping* grouping);
  void describe_unbalanced();
  void log(const std::string& line);

  RunFolder folder_;
  nlohmann::ordered_json record_;
  GrowingFile log_;
};

}  // namespace sinew
