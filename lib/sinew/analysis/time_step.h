// SPDX-License-Identifier: GPL-3.0-or-later
// How long a time step may be. The limits hold for small motions about rest and were confirmed by
// bisection; a strongly bent joint oscillates above 0.9 of them.
//
//     const double limit = step_limit(solver.integrator, body);
//     const StepChoice choice = choose_step({}, 0.5, limit, interval);
#pragma once

#include <optional>
#include <vector>

#include <sinew/body/body.h>
#include <sinew/body/bone_force.h>
#include <sinew/material/material.h>

namespace sinew {

/// Upper bounds of what surroundings add per particle; see added_stiffness() in world/world.h.
struct WorldLoad {
  double stiffness = 0;  ///< N/m
  double damping = 0;    ///< 1/s
};

/// What BondFactors::stiffest must be for the stiffest of the parts of a body that keep volumes of
/// their own; 0 without.
double stiffest_volume(const Body& body);

/// The largest stable step, s. Symplectic Euler and velocity Verlet, which damps with the half-step
/// velocity: (sqrt(g^2 + 4 w^2) - g) / w^2, the least over the modes inside the packing (damped at
/// g = (4/3) C/m, central (2/3) C/m) and those at its surface. Explicit Euler: the least over
/// lattice, damping and bones; 0 when no step is stable. `stiffest`: of the body's BondFactors; by
/// default that of rough surfaces.
double step_limit(Integrator integrator, const Material& material,
                  const std::vector<BoneSprings>& springs, const WorldLoad& world = {},
                  double stiffest = stiffest_of_rough_surfaces);

struct StepChoice {
  double limit = 0;   ///< limit of the integrator chosen, s
  double step = 0;    ///< s
  int per_frame = 0;  ///< steps in a frame interval, exactly
  double factor() const { return step / limit; }
};

/// The requested step, s, or without one `factor` times the limit, shortened so that a whole number
/// of steps makes a frame interval (s). Throws bad input without a request where no step is stable.
StepChoice choose_step(std::optional<double> step, double factor, double limit, double interval);

// The step limit of thin bodies. The closed forms above are those of an infinite packing; a body of
// fewer than about five planes of particles is softer, and withstands a longer step, or is damped
// more strongly, and needs a shorter one.

/// Whether no particle has two layers of others around it; false for no particles.
bool is_thin(const NeighborLists& nearest);

/// The largest step of symplectic Euler and velocity Verlet, s: small motions about rest, with
/// forces -K u - D v, grow with alternating sign once an eigenvalue of dt^2 / 4 K + dt / 2 D
/// reaches the mass. Found by power iteration on the body's own forces, less 1 %. The step limit of
/// the packing where no force depends on the motion.
double power_step_limit(const Body& body, const WorldLoad& world = {});

/// The largest stable step of a body, s: by power iteration for thin bodies of up to 100,000
/// particles with equal stiffness in contact and tension; otherwise by the closed forms.
double step_limit(Integrator integrator, const Body& body, const WorldLoad& world = {});

/// The longest step of explicit Euler for so many seconds where something is not damped, as the
/// paper's bones are not: such a motion of frequency w grows by exp(w^2 step time / 2), here by a
/// factor of e until the end. s.
double explicit_step_for(const Body& body, const WorldLoad& world, double duration);

}  // namespace sinew
