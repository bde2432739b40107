// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include <sinew/core/text.h>
#include <sinew/scene/check/warnings.h>
#include <sinew/scene/steps.h>
#include <sinew/scene/world.h>

namespace sinew {
namespace {

constexpr double costly = 3;

/// What the limit of the step depends on.
struct Limits {
  Integrator integrator;
  Material material;
  std::vector<BoneSprings> springs;
  WorldLoad load;
  double stiffest;

  double step() const { return step_limit(integrator, material, springs, load, stiffest); }
};

std::string times_text(double times) { return three_digits(times) + " times as many steps: "; }

}  // namespace

std::vector<std::string> costly_choices(const Prepared& prepared) {
  std::vector<std::string> notes;
  const Body& body = prepared.body;
  const Integrator integrator = prepared.settings.solver.integrator;
  // Explicit Euler takes longer steps where more is damped.
  if (prepared.load_steps || integrator == Integrator::explicit_euler) return notes;
  const Limits now{integrator, lightest(body), body.springs, load_of(body), body.factors.stiffest};
  const auto without = [&](auto&& leave_out, const std::string& what, const std::string& cure) {
    Limits other = now;
    leave_out(other);
    const double times = other.step() / now.step();
    if (times > costly) notes.push_back(what + " takes " + times_text(times) + cure);
  };
  without([](Limits& other) { other.material.damping = 0; },
          "the damping constant " + three_digits(body.material.damping) + " kg/s",
          "set material.damping_form to rigid, or a smaller material.damping or damping_ratio");
  if (!body.stiffness.empty())
    without(
        [](Limits& other) {
          other.stiffest = std::min(other.stiffest, stiffest_of_rough_surfaces);
        },
        "the stiffest part of the body, " +
            three_digits(*std::max_element(body.stiffness.begin(), body.stiffness.end())) +
            " times as stiff as its material,",
        "give it a smaller young_modulus, or make it rigid by world.pins or rigid parts");
  if (!body.density.empty())
    without([&](Limits& other) { other.material.mass = body.material.mass; },
            "the lightest part of the body, of " +
                three_digits(*std::min_element(body.density.begin(), body.density.end())) +
                " times its material's density,",
            "give it a larger density");
  without([](Limits& other) { other.load.stiffness = 0; }, "what the body touches or is pulled by",
          "give world.obstacles, fields or loads a smaller stiffness");
  without([](Limits& other) { other.load.damping = 0; }, "damping by the body's surroundings",
          "give world.drag, or damping and stick of world.obstacles, smaller values");
  const auto stiff = std::max_element(
      body.springs.begin(), body.springs.end(),
      [](const BoneSprings& a, const BoneSprings& b) { return a.stiffest() < b.stiffest(); });
  if (stiff != body.springs.end())
    without([](Limits& other) { other.springs.clear(); },
            "bone '" +
                body.skeleton.bones[static_cast<std::size_t>(stiff - body.springs.begin())].name +
                "', the stiffest on its particles,",
            "set binding.soften_below, or smaller binding.stiffness, twist_stiffness and "
            "axial_stiffness");
  return notes;
}

}  // namespace sinew
