// SPDX-License-Identifier: GPL-3.0-or-later
// Steps that another program makes for a run: the run is written for it, and its states are read
// into the simulation that writes the frames.
//
//     EngineSteps steps(engine, folder, simulation, run);
//     steps.advance(simulation, wanted);
#pragma once

#include <functional>
#include <string>

#include <sinew/engine/engine_files.h>
#include <sinew/engine/engine_talk.h>
#include <sinew/stepping/simulation.h>

namespace sinew {

/// An engine in another program.
struct Engine {
  std::string name;  ///< "lammps"
  int ranks = 1;
  bool gathers = false;  ///< frames are written by this program alone
  /// Begins to step the run in the folder.
  std::function<void(const EngineFolder& folder)> start;
  /// Waits for the next state. `wanted` is asked several times a second meanwhile. Throws where the
  /// engine ends without one.
  std::function<EngineStatus(const std::function<Interruption()>& wanted)> next;
  std::function<void()> finish;  ///< ends it, before its time if need be
};

class EngineSteps {
 public:
  /// Writes the run into `folder` and starts the engine there, at the present state of the
  /// simulation, which goes on by that plan.
  EngineSteps(Engine engine, const std::filesystem::path& folder, const Simulation& simulation,
              const Motion& motion, const Stepping& stepping, const StepPlan& plan,
              int steps_per_frame, int frames, std::optional<EnginePieces> pieces = {});

  /// Brings the simulation to the engine's next state. Throws as Simulation::step() does where the
  /// engine's step fails.
  void advance(Simulation& simulation, const std::function<Interruption()>& wanted);
  /// Returns the moment of the last state, without its ledger; with nothing before.
  const EngineMoment& moment() const { return moment_; }
  /// Ends the engine and removes its files, which a failed run keeps.
  void finish();

 private:
  Engine engine_;
  EngineFolder folder_;
  std::vector<std::int32_t> ids_;
  EngineMoment moment_;
};

}  // namespace sinew
