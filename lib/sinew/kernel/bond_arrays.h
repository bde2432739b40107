// SPDX-License-Identifier: GPL-3.0-or-later
// Bonds between neighbors at rest, as the kernel reads them. Plain, as kernel.h says.
#pragma once

#include <cstdint>

namespace sinew::kernel {

/// Bonds of some lanes of a block with the particles at one difference from them.
struct BondEntry {
  std::int32_t difference;
  std::uint32_t kind;
  std::uint32_t lanes;  ///< bit by lane, at rest and, 16 bits lower, now: what breaks is cleared
  std::int32_t own;     ///< row of Bonds::own, or -1: all lanes have the stiffness of the kind
};
inline constexpr int rest_lanes = 16;

/// Bonds that were equal and parallel at rest.
template <class Real>
struct BondKind {
  Real rest[3];  ///< to the neighbor
  Real length;
  Real stiffness;
};

/// A spring and a dashpot in series beside each bond: see material/maxwell.h.
template <class Real>
struct Branch {
  Real* stretch;       ///< entries x block: of its dashpot
  Real modulus_ratio;  ///< fraction of the bond's stiffness
  Real flows;          ///< fraction of its spring's stretch that passes to the dashpot now; often 0
  Real weight;         ///< weight of its stretch in the length at which the bond pulls nothing
};
inline constexpr int max_branches = 4;

/// What was found of a piece's bonds when their flow was: how far its particles are from yielding,
/// and what bounds how soon they may. Lengths in those of the kernel.
template <class Real>
struct FlowLook {
  Real spare;     ///< the least yield shear less shear; negative: something flows
  Real reach;     ///< the largest d + |d - l|
  Real tension;   ///< the largest |d - l| d
  Real nearest2;  ///< the least d squared
};

template <class Real>
struct Bonds {
  const std::uint32_t* first;   ///< entries of block k: [first[k], first[k + 1])
  const std::uint32_t* second;  ///< start of the bonds between second neighbors
  BondEntry* entries;
  const BondKind<Real>* kinds;
  const Real* own;       ///< rows x block: stiffness by lane, where it differs
  Real* creep;           ///< entries x block, added to the length; null: none creeps
  std::int32_t* broken;  ///< broken bonds of each particle
  Real* flow[6];         ///< one per particle: P of body/solid.h, x x, y y, z z, y z, z x, x y
  Real* flows;           ///< one per particle: positive where P is not 0
  FlowLook<Real>* look;  ///< one per piece
  Real yield;            ///< squared shear beyond which bonds creep; 0: never
  /// Values by particle, where they differ: `yield`; 1 + the strain at which bonds break. Or null.
  const Real* yield_of;
  const Real* breaking_of;
  Real crept;     ///< fraction that a step takes of it
  Real breaking;  ///< strain at which it breaks
  Branch<Real> branch[max_branches];
  int branches;
  bool branches_flow;  ///< one of them does now
  Real slope;          ///< slope of a bond's force, over its stiffness, where there are branches
};

}  // namespace sinew::kernel
