// SPDX-License-Identifier: GPL-3.0-or-later
// The bonds of a frame as lines for ParaView.
//
//     series.add(bonds_dataset(bond_values(rest, state), positions, ids, moment));
#pragma once

#include <cstdint>
#include <span>

#include <sinew/core/dataset.h>
#include <sinew/io/frames.h>
#include <sinew/metrics/pair_forces.h>

namespace sinew {

/// `positions` of all particles by id (n x 3, m); `ids`: the particles in the frame, ascending;
/// empty: all of them. Bonds that leave them are left out.
Dataset bonds_dataset(const BondValues& bonds, const Points& positions,
                      std::span<const std::int32_t> ids, Moment moment);

}  // namespace sinew
