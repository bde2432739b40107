// SPDX-License-Identifier: GPL-3.0-or-later
// What is known of every particle of a frame as arrays to be written: tensors in ParaView's order
// of components, XX YY ZZ XY YZ XZ for symmetric ones and row by row for F.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "core/dataset.h"
#include "metrics/body.h"

namespace sinew {

/// Those of requestable_arrays() that are named, in the written order of the particles;
/// not-a-number where a particle's neighbours define none, and stresses where the body's forces are
/// not known. Of the state, positions and bones count. In parallel.
std::vector<Column> particle_arrays(const RestBody& rest, const FrameState& state,
                                    std::span<const std::string_view> names);

}  // namespace sinew
