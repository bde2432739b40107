// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/check/rest_trial.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include <sinew/analysis/rest_stability.h>
#include <sinew/core/error.h>
#include <sinew/core/particles.h>
#include <sinew/core/text.h>
#include <sinew/material/laws.h>

namespace sinew {
namespace {

constexpr double duration = 10, interval = 0.5;  // s
constexpr double nudge = 3, nudge_time = 0.3;    // degrees; s there, and again back
constexpr std::size_t max_tried_particles = 4000;
constexpr int fewer_particles = 3000;
// Steps times particles, some ten seconds: stiff bodies are tried for less time.
constexpr double max_work = 4e8;

/// A bone's turn about an axis across it: y, if it does not lie along y.
TrackDefinition nudge_of(const Bone& bone) {
  TrackDefinition track;
  track.bone = bone.name;
  track.keys.resize(3);
  for (std::size_t n = 0; n < track.keys.size(); ++n)
    track.keys[n].time = nudge_time * static_cast<double>(n);
  track.keys[1].axis = std::abs(bone.axis().y()) < 0.9 ? Vec3::UnitY() : Vec3::UnitX();
  track.keys[1].angle = nudge;
  return track;
}

void stop(BodyOptions& body) { body.velocity = body.angular_velocity = Vec3::Zero(); }

/// The scene of the trial: the body on its bones, with nothing around it.
Settings scene_of_trial(const Prepared& prepared) {
  Settings scene = prepared.settings;
  for (PartOptions& part : scene.bodies) stop(part.body);
  stop(scene.body);
  scene.world = {};
  scene.loads.clear();
  scene.probes.clear();
  for (SupportSettings& support : scene.supports) support.keys.clear();
  scene.hierarchy = {};
  scene.output = {};
  scene.output.interval = interval;
  scene.solver.method = Method::dynamic;
  scene.solver.gravity = Vec3::Zero();
  scene.solver.duration = duration;
  scene.motion = {};
  scene.motion.preroll = 0;
  scene.tracks.clear();
  if (prepared.body.skeleton.size() > 0)
    scene.tracks = {nudge_of(prepared.body.skeleton.bones.back())};
  return scene;
}

/// The same with fewer particles; none where the scene cannot be prepared with them, as where a
/// region of it holds none.
std::optional<Prepared> coarse_trial(Scene scene) {
  scene.settings.body.radius.reset();
  scene.settings.body.count = fewer_particles;
  std::erase_if(scene.settings.bound, [](const BoundSettings& bound) { return bound.ids; });
  try {
    return prepare(std::move(scene));
  } catch (const Error&) {
    return std::nullopt;
  }
}

Prepared trial_of(const Prepared& prepared) {
  Scene scene{scene_of_trial(prepared)};
  scene.with_surface = false;
  scene.with_rig = prepared.body.skeleton.size() > 0;
  scene.law = prepared.body.material.law;
  if (prepared.body.rest.size() > max_tried_particles)
    if (std::optional<Prepared> coarse = coarse_trial(scene)) return *std::move(coarse);
  scene.filled = prepared.filled;
  return prepare(std::move(scene));
}

/// In place of a nudge where there are no bones: velocities that move particles by a twentieth of a
/// radius.
void shake(const Material& material, Particles& particles) {
  const double speed =
      0.05 * material.pair.r * std::sqrt(material.pair.contact_stiffness() / material.mass);
  std::mt19937_64 random(1);  // any seed: the same result each time
  for (auto* velocities : {&particles.u, &particles.v, &particles.w})
    for (double& one : *velocities)
      one = speed * (0x1p-52 * static_cast<double>(random() >> 11) - 1);
}

/// How far the particles are from where they were at rest, root mean square, radii.
double shift_of(const Simulation& simulation) {
  const Points now = positions_by_id(simulation.particles());
  const Points& rest = simulation.body().rest;
  double sum = 0;
  for (std::size_t i = 0; i < now.size(); ++i) sum += (now[i] - rest[i]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(now.size())) / simulation.body().material.pair.r;
}

RestState state_of(double shift) {
  return shift > collapsed_shift  ? RestState::unstable
         : shift > creeping_shift ? RestState::creeps
                                  : RestState::stable;
}

RestTrial tried(Simulation simulation, std::int64_t steps) {
  RestTrial trial;
  trial.particles = simulation.body().rest.size();
  try {
    const double affordable = max_work / static_cast<double>(trial.particles);
    simulation.advance(std::min(steps, static_cast<std::int64_t>(affordable) + 1));
    trial.shift = shift_of(simulation);
    trial.state = state_of(trial.shift);
  } catch (const Error& error) {
    if (error.exit() != Exit::unstable) throw;
    trial.shift = std::max(collapsed_shift, shift_of(simulation));
    trial.state = RestState::unstable;
  }
  trial.time = simulation.time();
  return trial;
}

}  // namespace

RestTrial try_rest(const Prepared& prepared) {
  const Material& material = prepared.body.material;
  if (law_of(material).has_memory || !second_neighbors_may_pull(material.pair)) return {};
  Prepared trial = trial_of(prepared);
  if (trial.motion.tracks.empty()) shake(trial.body.material, trial.filled.particles);
  const std::int64_t steps = trial.plan.steps_until(trial.frames.count);
  return tried(start(std::move(trial)), steps);
}

const char* name_of(RestState state) {
  return state == RestState::stable ? "stable" : state == RestState::creeps ? "creeps" : "unstable";
}

std::string text_of(const RestTrial& trial) {
  std::string text = name_of(trial.state);
  const bool whole = trial.time > duration - interval;
  if (trial.state == RestState::stable && (whole || trial.particles == 0)) return text;
  return text + ", " + three_digits(trial.shift) + " radii off after " + three_digits(trial.time) +
         " s of rest";
}

std::string warning_of(const RestTrial& trial) {
  if (trial.state != RestState::unstable) return "";
  return "the body does not keep its shape: " + three_digits(trial.shift) + " radii off after " +
         three_digits(trial.time) +
         " s of rest; set material.b to 2.75 or less, or material.model to bonded";
}

}  // namespace sinew
