// SPDX-License-Identifier: GPL-3.0-or-later
// The state of the stepper that checkpoints store.
#include <cmath>
#include <utility>

#include <sinew/physics/lists/list_stepper.h>

namespace sinew {

template <class Real>
void ListStepper<Real>::save(SimulationState& state) const {
  state.moving = state_.columns();
  state.kicked = kicked_;
  state.order = caller_;
  state.whole_numbers = {units_.length, units_.origin, units_box_, traveled_};
  state.mean_when_sorted = mean_when_sorted_;
}

template <class Real>
void ListStepper<Real>::restore(const SimulationState& state) {
  using Columns = MovingColumns<typename BlockState<Real>::Coord, Real>;
  const auto* moving = std::get_if<Columns>(&state.moving);
  if (moving == nullptr) throw not_a_state("it is in another precision");
  check_moving(*moving, caller_.size());
  if (!state.rest_length.empty()) throw not_a_state("it has bonds");
  restore_order(state.order);
  restore_units(state.whole_numbers);
  state_.set_columns(*moving);
  next_ = state_;
  find_slots();
  kicked_ = state.kicked;
  mean_when_sorted_ = state.mean_when_sorted;
  steps_ = state.steps;
  order_checked_ = -1;
  fastest_.reset();
  lists_ = VerletLists<Real>(kernel_, body_->material.pair, stepping_.step);
}

/// `order` contains each particle's place in the caller's order once.
template <class Real>
void ListStepper<Real>::restore_order(const std::vector<std::uint32_t>& order) {
  std::vector<std::int32_t> id_of(caller_.size(), -1);
  for (std::size_t k = 0; k < caller_.size(); ++k) id_of[caller_[k]] = id_[k + block];
  if (order.size() != id_of.size()) throw not_a_state("it has no order of the particles");
  std::vector<std::int32_t> id(id_.size(), 0);
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (order[k] >= id_of.size() || id_of[order[k]] < 0)
      throw not_a_state("its order of the particles names one twice");
    id[k + block] = std::exchange(id_of[order[k]], -1);
  }
  id_ = std::move(id);
  caller_ = order;
}

template <class Real>
void ListStepper<Real>::restore_units(const WholeNumbers& saved) {
  const bool sane = saved.length > 0 && std::isfinite(saved.length) && saved.origin.allFinite() &&
                    saved.box.min().allFinite() && saved.box.max().allFinite() &&
                    saved.traveled >= 0 && std::isfinite(saved.traveled);
  if (!sane) throw not_a_state("its units are invalid");
  units_.length = saved.length;
  units_.origin = saved.origin;
  units_box_ = saved.box;
  traveled_ = saved.traveled;
}

template void ListStepper<double>::save(SimulationState& state) const;
template void ListStepper<float>::save(SimulationState& state) const;
template void ListStepper<double>::restore(const SimulationState& state);
template void ListStepper<float>::restore(const SimulationState& state);

}  // namespace sinew
