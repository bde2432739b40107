// SPDX-License-Identifier: GPL-3.0-or-later
// Loads in the kernel's layout: accelerations, which it adds to those of all other forces.
//
//     LoadLists<Real> loads(world.loads, mass);
//     loads.set_order(id);
//     loads.find(now.loads, state, units, true);  // before a step
//     step.loads = loads.arrays();
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <sinew/body/forces.h>
#include <sinew/kernel/kernel.h>
#include <sinew/lists/block_state.h>
#include <sinew/world/loads.h>

namespace sinew {

template <class Real>
class LoadLists {
 public:
  LoadLists() = default;  ///< none
  /// `mass` by which forces are divided, kg. The loads must outlive this.
  LoadLists(std::span<const Load> loads, double mass);

  std::size_t size() const { return given_.size(); }
  /// The particles `id` in the kernel's order.
  void set_order(std::span<const std::int32_t> id);
  /// At a moment with the loads as they are then; `stepping`: for a step that follows.
  void find(std::span<const LoadAt> loads, const BlockState<Real>& state, const Units& units,
            bool stepping);
  kernel::Loads<Real> arrays() const;

  bool is_on(std::size_t block) const { return !on_.empty() && on_[block] != 0; }
  Vec3 force(std::size_t k) const;  ///< on particle k, N
  /// Adds what each load does to particle k at `position` with that `velocity`.
  void add(std::size_t k, const Vec3& position, const Vec3& velocity,
           std::span<Reaction> load_reactions) const;
  double sizes() const;  ///< the lengths of all forces, N

  void save(SimulationState& state) const { save_loads(now_, state); }
  void restore(const SimulationState& state) { restore_loads(state, now_); }

 private:
  /// A load's force on a particle, by its place among the load's particles.
  struct Loaded {
    std::uint32_t load, place;
  };

  std::span<const Load> given_;
  double mass_ = 0;
  std::vector<LoadNow> now_;
  std::vector<std::vector<std::uint32_t>> places_;  ///< places of the particles of each load
  std::vector<std::uint32_t> first_;                ///< first entry of particle k
  std::vector<Loaded> loaded_;
  std::vector<std::uint32_t> particles_;  ///< particles with loads, ascending
  std::vector<std::uint8_t> on_;          ///< one per block
  double per_force_ = 0;                  ///< acceleration per force, in units of the kernel
  std::array<std::vector<Real>, 3> acceleration_;
};

}  // namespace sinew
