// SPDX-License-Identifier: GPL-3.0-or-later
// How large the particles of a new scene are: first by the thickness of its limbs, then as small as
// a run may take.
//
//     choose_radius(surface, limbs, choices);
//     use_budget(tried(surface, choices), choices);
#pragma once

#include <optional>
#include <vector>

#include <sinew/rig/limbs.h>
#include <sinew/scene/new/new_scene.h>
#include <sinew/scene/prepare.h>

namespace sinew {

/// Rounds to what a person writes.
double three_figures(double value);

/// Chooses by the thickness of limbs; smaller where the body does not hold together.
void choose_radius(const Surface& surface, const std::vector<Limb>& limbs, NewChoices& choices);

/// The scene so far, prepared with this surface in place of its mesh, and from rest: what that
/// costs is known without the first pose; with particles at rest that were filled before, if any.
/// Throws bad input.
Prepared tried(const Surface& surface, const NewChoices& choices,
               std::optional<BodyFile> filled = {});

/// Chooses the smallest radius, none larger than the present one, with under 5e8 particle-steps and
/// 100,000 particles; where limbs are under four particles thick, but for those that hold a
/// twentieth of the body, up to 1e9 and 300,000; of a quick scene with under 1.2e7 and 5,000. Says
/// what time that takes. `first`: tried with the present radius.
void use_budget(const Prepared& first, NewChoices& choices);

}  // namespace sinew
