// SPDX-License-Identifier: GPL-3.0-or-later
// What changes where other particles move as one.
#include <sinew/physics/lists/list_stepper.h>
#include <sinew/physics/lists/particle_order.h>

namespace sinew {

template <class Real>
void ListStepper<Real>::regroup() {
  groups_.show_all(layout_.now, layout_.units());
  std::vector<std::int32_t> id(layout_.size());
  std::vector<std::uint32_t> place(layout_.size());
  for (std::uint32_t k = 0; k < place.size(); ++k) {
    const std::uint32_t i = layout_.caller()[k];
    id[i] = layout_.id()[k];
    place[i] = k;
  }
  std::vector<std::uint32_t> order = order_at_rest(*body_, id);
  for (std::uint32_t& one : order) one = place[one];
  layout_.reorder(order);
  groups_ = Groups<Real>(body_, mass_, kernel_);
  bonds_ = bond_lists<Real>(*body_, mass_, layout_.id(), layout_.units());  // none has changed
  strain_ = strain_lists<Real>(*body_, mass_, layout_.id(), bonds_, layout_.units());
  find_slots();
  groups_.begin(layout_.now, layout_.units());
  lists_ = lists_.anew(stepping_.step);
  stepped_ = false;
}

template <class Real>
std::vector<HeldCell> ListStepper<Real>::held(std::span<const std::int32_t> cell,
                                              std::size_t cells) const {
  std::vector<HeldCell> held(cells);
  groups_.add_held(cell, layout_.units(), held);
  return held;
}

template void ListStepper<double>::regroup();
template void ListStepper<float>::regroup();
template std::vector<HeldCell> ListStepper<double>::held(std::span<const std::int32_t>,
                                                         std::size_t) const;
template std::vector<HeldCell> ListStepper<float>::held(std::span<const std::int32_t>,
                                                        std::size_t) const;

}  // namespace sinew
