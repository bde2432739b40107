// SPDX-License-Identifier: GPL-3.0-or-later
// The fibers of muscles in the kernel's layout: kernel/strain_arrays.h has the formulas,
// world/muscles.h their source.
//
//     FiberLists<Real> fibers = fiber_lists(body, mass, id, bonds, units);
//     fibers.set_activations(activations_at(muscles, time));
//     step.fibers = fibers.arrays();
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <sinew/body/body.h>
#include <sinew/core/lines.h>
#include <sinew/kernel/kernel.h>
#include <sinew/lists/bond_lists.h>
#include <sinew/world/world.h>

namespace sinew {

template <class Real>
class FiberLists {
 public:
  /// One fiber of every particle that has so many.
  struct Layer {
    std::vector<std::uint32_t> first;  ///< slots of a block
    std::vector<std::int32_t> muscle;
    Lines<Real> strength;
    std::vector<std::uint8_t> near;
    std::vector<kernel::FiberRows> rows;
    Lines<Real> coefficients;         ///< equal rows are stored once
    Lines<Real> own;                  ///< one per particle
    std::array<Lines<Real>, 3> pull;  ///< one per particle, with a block of zeros at each end
  };

  FiberLists() = default;
  FiberLists(std::vector<Layer> layers, std::size_t muscles)
      : layers_(std::move(layers)), level_(muscles, 0) {}

  bool empty() const { return layers_.empty(); }
  void set_activations(const Activations& now);
  /// They are valid until this is called again.
  kernel::Fibers<Real> arrays();

 private:
  std::vector<Layer> layers_;
  std::vector<kernel::FiberLayer<Real>> arrays_;
  std::vector<Real> level_;
};

/// Lists fibers of particles of `mass` (kg), `id` in the kernel's order, with neighbors at rest.
template <class Real>
FiberLists<Real> fiber_lists(const Body& body, double mass, std::span<const std::int32_t> id,
                             const BondLists<Real>& bonds, const Units& units);

}  // namespace sinew
