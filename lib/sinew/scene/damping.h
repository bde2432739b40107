// SPDX-License-Identifier: GPL-3.0-or-later
// The damping that a scene asks for, for the body as it is held.
#pragma once

#include <optional>

#include <sinew/analysis/elastic_modes.h>
#include <sinew/body/body.h>
#include <sinew/settings/settings.h>

namespace sinew {

/// Gives a body that moves, held as it will be, the damping ratio of its lowest mode that the
/// settings ask for, if they do: by eq. 2, and in the form rigid by damping relative to what holds
/// it; bones may give more. Or material.rayleigh: eq. 2 with the share of beta in the lowest mode,
/// and damping of alpha relative to what holds it. `modes`: found where they are needed and
/// missing.
void set_damping(const Settings& settings, Body& body, std::optional<ElasticModes>& modes);

}  // namespace sinew
