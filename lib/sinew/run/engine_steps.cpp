// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/run/engine_steps.h>

#include <utility>

#include <sinew/core/error.h>
#include <sinew/core/text.h>

namespace sinew {

EngineSteps::EngineSteps(Engine engine, const std::filesystem::path& folder,
                         const Simulation& simulation, const Motion& motion,
                         const Stepping& stepping, const StepPlan& plan, int steps_per_frame,
                         int frames, std::optional<EnginePieces> pieces)
    : engine_(std::move(engine)), folder_{folder}, ids_(simulation.particles().id) {
  std::error_code missing;
  std::filesystem::remove_all(folder, missing);  // clears what a run that failed has left
  write_engine_run(
      folder_, {simulation.body(), motion, stepping, plan, steps_per_frame, frames,
                simulation.particles().mass, simulation.save(), ids_, false, std::move(pieces)});
  engine_.start(folder_);
}

void EngineSteps::advance(Simulation& simulation, const std::function<Interruption()>& wanted) {
  const EngineStatus news = engine_.next(wanted);
  if (news.steps != simulation.steps()) {
    moment_ = read_engine_moment(folder_, news.steps);
    simulation.restore(read_engine_state(folder_, news.steps, simulation.save(), ids_));
    remove_engine_state(folder_, news.steps, engine_.ranks);
  }
  if (!news.unstable) return;
  simulation.step();  // fails alike, and says why
  throw Error(Exit::unstable,
              "step " + std::to_string(news.steps) + " at " + three_digits(simulation.time()) +
                  " s: a particle moved too far, by a rounding error only; use "
                  "solver.time_step " +
                  three_digits(0.5 * simulation.time() / double(news.steps + 1)) + " or less");
}

void EngineSteps::finish() {
  engine_.finish();
  std::error_code missing;
  std::filesystem::remove_all(folder_.path, missing);
}

}  // namespace sinew
