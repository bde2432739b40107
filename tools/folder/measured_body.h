// SPDX-License-Identifier: GPL-3.0-or-later
// What metrics have to know of a body and of the forces in it.
#pragma once

#include "folder/run_files.h"
#include "metrics/body.h"
#include "metrics/frame.h"
#include "physics/material.h"
#include "rig/skeleton.h"

namespace sinew {

/// The constants that the run's particles had.
Material material_of(const RunFiles& run);

/// The material's forces between particles, as far as their positions decide them: empty where
/// bonds break or creep, which depends on the past.
PairLaw pair_law(const Material& material);

/// Radius, range, mass and forces from the material; the bones from the skeleton. Positions,
/// surface and the bones of particles are the caller's.
RestInput measured_body(const Material& material, const Skeleton& skeleton);

/// The same of a run's files, with its body at rest.
RestInput measured_body(const RunFiles& run);

/// A frame as metrics take it.
FrameState measured_frame(RunFrame frame);

}  // namespace sinew
