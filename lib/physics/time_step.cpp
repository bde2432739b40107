// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/time_step.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/number_text.h"

namespace sinew {
namespace {

bool is_central(const Material& material) { return material.damping_form == DampingForm::central; }

/// A kind of mode that may become unstable first: decay rate by eq. 2, and frequency squared.
struct Mode {
  double rate;  // C / m
  double w2;    // k / m
};

/// Highest frequency of the packing, w^2 in k / m.
double lattice_factor(const Material& material) {
  return highest_frequency_factor(material.volume_stiffness / (2 * material.pair.k1));
}

/// Within the packing (exact), and at its surface, where few partners make the damping of eq. 2
/// stronger and the springs softer (the most found by power iteration on boxes and balls).
std::array<Mode, 2> worst_modes(const Material& material) {
  const double w2 = lattice_factor(material);
  if (is_central(material)) return {Mode{2.0 / 3, w2}, Mode{0.87, w2 * 5 / 8}};
  return {Mode{4.0 / 3, w2}, Mode{1.52, w2 * 5 / 8}};
}

double largest_damping(const std::vector<BoneSprings>& springs) {
  double most = 0;
  for (const BoneSprings& bone : springs) most = std::max(most, bone.damping);
  return most;
}

double stiffest_spring(const std::vector<BoneSprings>& springs) {
  double most = 0;
  for (const BoneSprings& bone : springs) most = std::max(most, bone.stiffest());
  return most;
}

double semi_implicit_limit(const Material& material, const std::vector<BoneSprings>& springs,
                           const WorldLoad& world) {
  double limit = std::numeric_limits<double>::infinity();
  for (const Mode& mode : worst_modes(material)) {
    const double k = mode.w2 * material.stiffness() + stiffest_spring(springs) + world.stiffness;
    const double w2 = k / material.mass;
    const double g =
        (mode.rate * material.damping + largest_damping(springs)) / material.mass + world.damping;
    limit = std::min(limit, 4 / (std::sqrt(g * g + 4 * w2) + g));  // (sqrt(g^2 + 4 w^2) - g) / w^2
  }
  return limit;
}

double explicit_limit(const Material& material, const std::vector<BoneSprings>& springs,
                      const WorldLoad& world) {
  const double C = material.damping;
  const double share = is_central(material) ? 1.5 : 1, k = material.stiffness();
  double limit = C / (share * lattice_factor(material) * k + share * world.stiffness);
  for (const Mode& mode : worst_modes(material))
    if (C > 0)
      limit = std::min(
          limit, 2 * material.mass /
                     (mode.rate * C + largest_damping(springs) + material.mass * world.damping));
  for (const BoneSprings& bone : springs)
    if (bone.stiffest() > 0) limit = std::min(limit, bone.damping / bone.stiffest());
  return limit;
}

}  // namespace

double highest_frequency_squared(const Material& material,
                                 const std::vector<BoneSprings>& springs) {
  return (lattice_factor(material) * material.stiffness() + stiffest_spring(springs)) /
         material.mass;
}

double step_limit(Integrator integrator, const Material& material,
                  const std::vector<BoneSprings>& springs, const WorldLoad& world) {
  return integrator == Integrator::explicit_euler ? explicit_limit(material, springs, world)
                                                  : semi_implicit_limit(material, springs, world);
}

StepChoice choose_step(const SolverSettings& settings, double limit, double interval) {
  if (!settings.time_step && !(limit > 0))
    throw bad_input(
        "explicit_euler has no stable time step without damping",
        "set material.damping and binding.bone_damping above 0, or use symplectic_euler");
  const double wanted = settings.time_step.value_or(settings.time_step_factor * limit);
  // The tolerance keeps a step that divides the interval from becoming one shorter by rounding.
  const double steps = std::ceil(interval / wanted * (1 - 1e-12));
  if (!(steps < 1e9))
    throw bad_input("a frame would take " + three_digits(steps) + " steps",
                    "make solver.time_step longer or output.interval shorter");
  StepChoice choice;
  choice.limit = limit;
  choice.per_frame = std::max(1, static_cast<int>(steps));
  choice.step = interval / choice.per_frame;
  return choice;
}

}  // namespace sinew
