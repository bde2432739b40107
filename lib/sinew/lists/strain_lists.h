// SPDX-License-Identifier: GPL-3.0-or-later
// What the kernel needs for forces that follow from the deformation around each particle: volumes
// that are kept, and the fibers of muscles.
//
//     StrainLists<Real> strain = strain_lists<Real>(body, mass, id, bonds, units);
//     strain.put_into(step);
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <sinew/body/body.h>
#include <sinew/core/lines.h>
#include <sinew/kernel/kernel.h>
#include <sinew/lists/bond_lists.h>
#include <sinew/lists/fiber_lists.h>

namespace sinew {

template <class Real>
struct StrainLists {
  // Values by particle, with a block of zeros at each end.
  std::array<Lines<Real>, 6> inverse;
  Lines<Real> stiffness, growth;  ///< arrays of volumes; empty: none is kept
  std::array<Lines<Real>, 9> thrust;
  FiberLists<Real> fibers;

  bool empty() const { return stiffness.empty() && fibers.empty(); }
  void put_into(kernel::Step<Real>& step);
};

/// Makes lists of particles of `mass` (kg), `id` in the kernel's order, with their bonds: those
/// that lost one keep no volume.
template <class Real>
StrainLists<Real> strain_lists(const Body& body, double mass, std::span<const std::int32_t> id,
                               const BondLists<Real>& bonds, const Units& units);

}  // namespace sinew
