// SPDX-License-Identifier: GPL-3.0-or-later
// The bonds of a solid in the kernel's layout: for each block the differences to the neighbors of
// its particles at rest, with the lanes that have one there. They are made once: bonds stay where
// they are, creep, relax and break.
//
//     BondLists<Real> bonds = bond_lists<Real>(body, mass, id, units);
//     step.bonds = bonds.arrays(body.material, step);
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <sinew/body/body.h>
#include <sinew/body/solid.h>
#include <sinew/core/lines.h>
#include <sinew/kernel/kernel.h>
#include <sinew/lists/block_state.h>
#include <sinew/lists/bond_branches.h>

namespace sinew {

template <class Real>
struct BondLists {
  std::vector<std::uint32_t> first;        ///< blocks + 1 long; empty: the material knows no bonds
  std::vector<std::uint32_t> second;       ///< one per block: where those of second neighbors begin
  std::vector<kernel::BondEntry> entries;  ///< entries by block: ascending differences, then kinds
  std::vector<Vec3> rest;                  ///< one per kind, m
  std::vector<double> kind_factor;         ///< on its stiffness; 0: of several bonds, none
  std::vector<kernel::BondKind<Real>> kinds;
  Lines<Real> own;    ///< rows x block: stiffness by lane, with the body's factors
  Lines<Real> creep;  ///< entries x block; empty: none creeps
  BondBranches<Real> branches;
  std::vector<std::int32_t> broken;  ///< one per particle, padded; empty: none breaks
  /// Flow by particle, with a block of zeros at each end, where bonds creep: see kernel::Bonds.
  std::array<Lines<Real>, 6> flow;
  Lines<Real> flows;
  std::vector<kernel::FlowLook<Real>> look;  ///< one per piece; empty: none flows
  /// Values laid out as flow, where particles differ: see kernel::Bonds.
  Lines<Real> yield, breaking;

  /// Lengths and stiffness in these units; `id` in the kernel's order.
  void set_units(const Body& body, std::span<const std::int32_t> id, double mass,
                 const Units& units);
  /// For steps of `step` (s).
  kernel::Bonds<Real> arrays(const Material& material, double step);
  /// Lanes of a block that are bonded to nearest neighbors at a difference.
  std::uint32_t bonded_lanes(std::size_t block, std::int32_t difference) const;

  /// Whether steps change them.
  bool change() const { return !broken.empty() || !creep.empty() || !branches.empty(); }

  /// What is whole, with the length at which it pulls nothing; `id` in the kernel's order.
  void read(std::span<const std::int32_t> id, const Units& units, BondRest& found) const;

  /// What changes: of each entry the lanes that are whole, what those have crept by, and branches.
  void save(SimulationState& state) const;
  /// Restores those of the same particles in the same order. Throws bad input for other bonds.
  void restore(const SimulationState& state);

 private:
  template <class StiffnessOf>
  void set_own(const BondFactors& factors, std::span<const std::int32_t> id,
               const StiffnessOf& stiffness_of);
};

/// Lists bonds of particles of `mass` (kg), `id` in the kernel's order. None where no force depends
/// on the neighbors at rest. Made for lattices: elsewhere each bond is a kind of its own.
template <class Real>
BondLists<Real> bond_lists(const Body& body, double mass, std::span<const std::int32_t> id,
                           const Units& units);

}  // namespace sinew
