// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/run/engine_steps.h>

#include <algorithm>
#include <array>
#include <utility>

#include <sinew/core/error.h>
#include <sinew/core/text.h>

namespace sinew {
namespace {

struct Unsupported {
  const char* key;
  const char* what;
  const char* cure;
  bool (*asked)(const Settings&);
};

template <class List, class Test>
bool any_of(const List& list, Test&& test) {
  return std::any_of(list.begin(), list.end(), test);
}

constexpr std::array<Unsupported, 16> unsupported = {{
    {"solver.precision", "single precision", "set it to double",
     [](const Settings& scene) { return scene.solver.precision != Precision::binary64; }},
    {"solver.neighbor_search", "the paper's cells", "set it to lists",
     [](const Settings& scene) { return scene.solver.neighbor_search != NeighborSearch::lists; }},
    {"solver.method", "equilibria", "set it to dynamic",
     [](const Settings& scene) { return scene.solver.method != Method::dynamic; }},
    {"hierarchy.enabled", "groups of particles", "set it to false",
     [](const Settings& scene) { return scene.hierarchy.enabled; }},
    {"material.breaking_strain", "bonds that break", "leave it out",
     [](const Settings& scene) { return scene.material.breaking_strain.has_value(); }},
    {"material.fracture_energy", "bonds that break", "leave it out",
     [](const Settings& scene) { return scene.material.fracture_energy.has_value(); }},
    {"material.yield_strain", "bonds that creep", "leave it out",
     [](const Settings& scene) { return scene.material.yield_strain.has_value(); }},
    {"material.relaxation_shares", "bonds that relax", "leave it out",
     [](const Settings& scene) { return scene.material.relaxation_shares.has_value(); }},
    {"materials", "parts that differ in more than stiffness", "leave them out",
     [](const Settings& scene) {
       const bool volumes = scene.material.model == MaterialModel::bonded_volume;
       return any_of(scene.materials, [&](const auto& one) {
         return one.has_strength() || one.density || (volumes && one.is_elastic());
       });
     }},
    {"bodies", "bodies that differ in more than stiffness", "leave them out",
     [](const Settings& scene) {
       return scene.material.model == MaterialModel::bonded_volume &&
              any_of(scene.bodies, [](const auto& one) { return one.young_modulus.has_value(); });
     }},
    {"contact.pass_through", "flesh that passes through flesh", "leave it out",
     [](const Settings& scene) { return scene.contact.pass_through.any(); }},
    {"binding.max_force", "bones whose holds yield", "leave it out",
     [](const Settings& scene) { return scene.binding.max_force.has_value(); }},
    {"material.friction", "friction of a body on itself", "leave it out",
     [](const Settings& scene) { return scene.material.friction > 0; }},
    {"world.obstacles", "obstacles of meshes", "choose another shape",
     [](const Settings& scene) {
       return any_of(scene.world.obstacles,
                     [](const auto& one) { return one.shape == ObstacleShape::mesh; });
     }},
    {"world.muscles", "muscles", "leave them out",
     [](const Settings& scene) { return !scene.world.muscles.empty(); }},
    {"loads", "pressures", "leave them out",
     [](const Settings& scene) {
       return any_of(scene.loads, [](const auto& one) { return one.pressure.has_value(); });
     }},
}};

}  // namespace

void refuse_for_engine(const Settings& settings, const std::string& engine) {
  for (const Unsupported& one : unsupported)
    if (one.asked(settings))
      throw bad_input(settings.place(one.key), "engine " + engine + " does not support " + one.what,
                      std::string(one.cure) + ", or run without --engine");
}

EngineSteps::EngineSteps(Engine engine, const std::filesystem::path& folder,
                         const Simulation& simulation, const Motion& motion,
                         const Stepping& stepping, const StepPlan& plan, int steps_per_frame,
                         int frames, std::optional<EnginePieces> pieces)
    : engine_(std::move(engine)), folder_{folder}, ids_(simulation.particles().id) {
  std::error_code missing;
  std::filesystem::remove_all(folder, missing);  // of a run that failed
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
