// SPDX-License-Identifier: GPL-3.0-or-later
// The step limit of bodies that have no inside. The closed forms of time_step.h are those of the
// packing without end; a body below some five planes of particles is softer than that, and bears a
// longer step, or damps more strongly, and bears a shorter one.
#pragma once

#include "physics/forces.h"
#include "physics/time_step.h"

namespace sinew {

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
