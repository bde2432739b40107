// SPDX-License-Identifier: GPL-3.0-or-later
// The features of a body in its world that exclude others (core/capabilities.h).
#pragma once

#include <sinew/body/body.h>
#include <sinew/core/capabilities.h>

namespace sinew {

Features features_of(const Body& body);

}  // namespace sinew
