// SPDX-License-Identifier: GPL-3.0-or-later
// Choices of a scene that make its steps much shorter than the body alone asks for.
#pragma once

#include <string>
#include <vector>

#include <sinew/scene/prepare.h>

namespace sinew {

/// One line for each choice without which the run would take less than a third of its steps: what
/// it is, how often, and the cure.
std::vector<std::string> costly_choices(const Prepared& prepared);

}  // namespace sinew
