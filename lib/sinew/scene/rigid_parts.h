// SPDX-License-Identifier: GPL-3.0-or-later
// Parts too thin for their particles to bend as the body does, which follow their bones rigidly
// (binding.rigid_below), and bones of few particles (binding.soften_below).
//
//     hold_rigid_parts(settings.binding, prepared.body);
#pragma once

#include <string>
#include <vector>

#include <sinew/body/body.h>
#include <sinew/settings/settings.h>

namespace sinew {

/// How many particles the body is thick around each: as many layers as have the same variance, in
/// the direction in which it is the least, as the particles of its bone and of those joined to it
/// within 6 radii; of these estimates the largest within 5 radii. 5 or more: thick. In parallel.
std::vector<double> particles_across(const Body& body);

/// Holds the particles where the body is thinner than `binding.rigid_below` to their heaviest
/// bones, like pins; other pins come first. Bones that hold no others pull no more.
void hold_rigid_parts(const BindingOptions& binding, Body& body);

/// One line where parts follow their bones rigidly, one where bones are softened, with the time
/// step that they would need.
std::vector<std::string> thin_part_notes(const BindingOptions& binding, const Body& body,
                                         double time_step);

}  // namespace sinew
