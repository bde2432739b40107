// SPDX-License-Identifier: GPL-3.0-or-later
// What is read of bonds, saved and restored.
#include <cmath>
#include <utility>

#include <sinew/physics/lists/bond_lists.h>
#include <sinew/physics/stepper.h>

namespace sinew {

template <class Real>
void BondLists<Real>::read(std::span<const std::int32_t> id, const Units& units,
                           BondRest& found) const {
  constexpr std::size_t size = kernel::Traits<Real>::block;
  for (std::size_t block = 0; block + 1 < first.size(); ++block)
    for (std::uint32_t e = first[block]; e < first[block + 1]; ++e)
      for (std::size_t lane = 0; lane < size; ++lane) {
        const kernel::BondEntry& entry = entries[e];
        if ((entry.lanes >> lane & 1) == 0) continue;
        const std::size_t k = block * size + lane;
        const double crept = (creep.empty() ? 0 : static_cast<double>(creep[e * size + lane])) +
                             branches.shift(e * size + lane);
        found.set(id[k], id[k + static_cast<std::size_t>(entry.difference)], e < second[block],
                  (static_cast<double>(kinds[entry.kind].length) + crept) * units.length);
      }
}

template <class Real>
void BondLists<Real>::save(SimulationState& state) const {
  if (!change()) return;
  state.bonded_lanes.clear();
  state.creep.clear();
  for (const kernel::BondEntry& entry : entries) state.bonded_lanes.push_back(entry.lanes);
  const auto add = [&](std::size_t at) { state.creep.push_back(static_cast<double>(creep[at])); };
  if (!creep.empty()) for_each_whole<kernel::Traits<Real>::block>(entries, add);
  branches.save(entries, state);
}

template <class Real>
void BondLists<Real>::restore(const SimulationState& state) {
  constexpr std::size_t size = kernel::Traits<Real>::block;
  if (!change()) return;
  if (state.bonded_lanes.size() != entries.size()) throw not_a_state("it has other bonds");
  for (std::size_t block = 0; block + 1 < first.size(); ++block)
    for (std::uint32_t e = first[block]; e < first[block + 1]; ++e) {
      const std::uint32_t made = std::exchange(entries[e].lanes, state.bonded_lanes[e]);
      if ((entries[e].lanes & ~made) != 0 || (made & ~entries[e].lanes) >> kernel::rest_lanes != 0)
        throw not_a_state("it has other bonds");
      for (std::size_t lane = 0; lane < size && !broken.empty(); ++lane)
        broken[block * size + lane] +=
            static_cast<std::int32_t>((made & ~entries[e].lanes) >> lane & 1);
    }
  std::size_t next = 0;
  const auto take = [&](std::size_t at) {
    if (next == state.creep.size() || !std::isfinite(state.creep[next]))
      throw not_a_state("a bond has no length");
    creep[at] = static_cast<Real>(state.creep[next++]);
  };
  if (!creep.empty()) for_each_whole<size>(entries, take);
  if (next != state.creep.size()) throw not_a_state("it has other bonds");
  branches.restore(entries, state);
}

template void BondLists<double>::read(std::span<const std::int32_t>, const Units&, BondRest&) const;
template void BondLists<float>::read(std::span<const std::int32_t>, const Units&, BondRest&) const;
template void BondLists<double>::save(SimulationState&) const;
template void BondLists<float>::save(SimulationState&) const;
template void BondLists<double>::restore(const SimulationState&);
template void BondLists<float>::restore(const SimulationState&);

}  // namespace sinew
