// SPDX-License-Identifier: GPL-3.0-or-later
// A motion that shows the joints of a rig without a clip.
#pragma once

#include <vector>

#include <sinew/body/body.h>
#include <sinew/scene/new_scene.h>

namespace sinew {

/// The joints, at most twelve, on both sides of which there is flesh; of more those whose bones
/// hold the most particles. Ascending.
std::vector<int> joints_that_skin_follows(const Body& body);

/// Bends them one after the other, as they are bent at rest, and back. Leaves the motion as it is
/// where there are none.
void bend_joints(const Body& body, NewChoices& choices);

}  // namespace sinew
