// SPDX-License-Identifier: GPL-3.0-or-later
// How long a time step may be. The limits hold for small motions about rest and were confirmed by
// bisection; a strongly bent joint rattles above 0.9 of them.
#pragma once

#include <optional>
#include <vector>

#include <sinew/physics/bone_force.h>
#include <sinew/physics/forces.h>
#include <sinew/physics/material.h>

namespace sinew {

/// What surrounds a body adds at most to one particle; see added_stiffness of world/world.h.
struct WorldLoad {
  double stiffness = 0;  ///< N/m
  double damping = 0;    ///< 1/s
};

/// Highest frequency of the packed body on its bones: w^2 = 8 k / m (more where volumes are kept) +
/// (stiffest bone spring) / m, in 1/s^2. (A body cut from the packing is no stiffer than the
/// packing.)
double highest_frequency_squared(const Material& material, const std::vector<BoneSprings>& springs);

/// The largest stable step, s. Symplectic Euler and velocity Verlet, which damps with the half-step
/// velocity: (sqrt(g^2 + 4 w^2) - g) / w^2, the least of what the modes within the packing (damped
/// at g = (4/3) C/m, central (2/3) C/m) and those at its surface allow. Explicit Euler: the least
/// of what lattice, damping and bones allow; 0 when no step is stable.
double step_limit(Integrator integrator, const Material& material,
                  const std::vector<BoneSprings>& springs, const WorldLoad& world = {});

struct StepChoice {
  double limit = 0;   ///< of the integrator chosen, s
  double step = 0;    ///< s
  int per_frame = 0;  ///< steps that make a frame interval, exactly
  double factor() const { return step / limit; }
};

/// The step asked for, s, or where none is `factor` times the limit, made shorter so that whole
/// steps make a frame interval (s). Throws bad input when none is asked for and no step is stable.
StepChoice choose_step(std::optional<double> step, double factor, double limit, double interval);

// The step limit of bodies that have no inside. The closed forms of time_step.h are those of the
// packing without end; a body below some five planes of particles is softer than that, and bears a
// longer step, or damps more strongly, and bears a shorter one.

/// Whether no particle lies under two layers of others; false for no particles.
bool is_thin(const Points& rest, double radius);

/// The largest step of symplectic Euler and velocity Verlet, s: small motions about rest, forces
/// -K u - D v, grow by turns of sign once an eigenvalue of dt^2 / 4 K + dt / 2 D reaches the mass.
/// Found by power iteration on the body's own forces, less 1 %. That of the packing where no force
/// answers to motion.
double power_step_limit(const Body& body, const WorldLoad& world = {});

/// The largest stable step of a body, s: by power iteration where it is thin, up to 100,000
/// particles, with equal stiffness in contact and tension; otherwise by the closed forms.
double step_limit(Integrator integrator, const Body& body, const WorldLoad& world = {});

}  // namespace sinew
