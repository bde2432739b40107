// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/groups/groups.h>

#include <utility>

#include <sinew/core/error.h>
#include <sinew/groups/detail/group_layout.h>
#include <sinew/groups/detail/group_limits.h>
#include <sinew/groups/detail/group_motions.h>
#include <sinew/groups/detail/group_shapes.h>

namespace sinew {

/// Stays where it is: its members refer to each other.
template <class Real>
struct Groups<Real>::Impl {
  Impl(std::shared_ptr<const Body> of, double mass, const kernel::Functions<Real>& kernel)
      : body(std::move(of)),
        shapes(group_shapes(*body)),
        layout(*body, shapes),
        motions(*body, mass, kernel, shapes, layout),
        limits(*body, kernel, shapes, layout, motions) {}
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  std::shared_ptr<const Body> body;
  std::vector<GroupShape> shapes;
  GroupLayout<Real> layout;
  GroupMotions<Real> motions;
  GroupLimits<Real> limits;
};

template <class Real>
Groups<Real>::Groups() = default;
template <class Real>
Groups<Real>::Groups(Groups&&) noexcept = default;
template <class Real>
Groups<Real>& Groups<Real>::operator=(Groups&&) noexcept = default;
template <class Real>
Groups<Real>::~Groups() = default;

template <class Real>
Groups<Real>::Groups(std::shared_ptr<const Body> body, double mass,
                     const kernel::Functions<Real>& kernel) {
  if (body->grouping && body->grouping->size() > 0)
    impl_ = std::make_unique<Impl>(std::move(body), mass, kernel);
}

template <class Real>
void Groups<Real>::set_order(std::span<const std::int32_t> id, const BondLists<Real>& bonds,
                             bool two_deep) {
  if (!any()) return;
  impl_->layout.set_order(id, bonds, two_deep);
  impl_->motions.set_order(bonds);
  impl_->limits.set_order();
}

template <class Real>
void Groups<Real>::begin(const BlockState<Real>& state, const Units& units) {
  if (!any()) return;
  impl_->motions.begin(state, units);
  impl_->limits.look_again();
}

template <class Real>
void Groups<Real>::watch(const kernel::Lists* lists, std::span<const std::uint32_t> pieces,
                         const BondLists<Real>& bonds,
                         const std::function<bool(std::size_t)>& meets) {
  if (any()) impl_->layout.watch(lists, pieces, bonds, meets);
}

template <class Real>
void Groups<Real>::place(BlockState<Real>& state, const Units& units) {
  if (any()) impl_->motions.place(state, units);
}

template <class Real>
void Groups<Real>::show_all(BlockState<Real>& state, const Units& units) {
  if (!any()) return;
  std::vector<std::uint32_t> all(impl_->layout.pieces());
  for (std::uint32_t piece = 0; piece < all.size(); ++piece) all[piece] = piece;
  impl_->motions.show(state, units, all);
}

template <class Real>
void Groups<Real>::activate(BlockState<Real>& state, const Units& units) {
  if (any()) impl_->layout.activate(state, units);
}

template <class Real>
GroupedParticles Groups<Real>::seen(BlockState<Real>& state, const Units& units) {
  if (!any()) return {};
  const auto show = [impl = impl_.get(), &state, &units](std::span<const std::uint32_t> pieces) {
    impl->motions.show(state, units, pieces);
  };
  const auto now = [impl = impl_.get(), &units](std::size_t piece) {
    return impl->limits.piece_now(piece, units);
  };
  return {show, impl_->layout.group_of_pieces(), now, impl_->limits.strains(),
          impl_->layout.working_pieces()};
}

template <class Real>
bool Groups<Real>::is_idle(std::size_t k) const {
  return any() && impl_->layout.is_idle(k / BlockState<Real>::block);
}

template <class Real>
kernel::Grouped<Real> Groups<Real>::arrays() {
  kernel::Grouped<Real> grouped{};
  if (!any()) return grouped;
  impl_->layout.put_into(grouped);
  impl_->motions.put_into(grouped);
  return grouped;
}

template <class Real>
void Groups<Real>::step(const BondLists<Real>& bonds, const kernel::Step<Real>& step,
                        const Units& units, const GroupStep& by,
                        const std::function<bool(std::size_t)>& meets,
                        std::span<kernel::Totals> totals) {
  if (!any()) return;
  impl_->motions.sum(bonds, step, units, by);
  impl_->limits.bound(units, by, meets, step.subpieces, totals);
  impl_->limits.check_stretch();
}

template <class Real>
GroupSums Groups<Real>::sums() const {
  return any() ? impl_->motions.sums() : GroupSums();
}

template <class Real>
void Groups<Real>::advance() {
  if (any()) impl_->motions.advance();
}

template <class Real>
void Groups<Real>::add_constrained(std::span<const std::int32_t> cell, const Units& units,
                                   std::span<ConstrainedCell> constrained) const {
  if (any()) impl_->motions.add_constrained(cell, units, constrained);
}

template <class Real>
void Groups<Real>::constrain(Forces& forces, const std::vector<std::uint32_t>& caller,
                             const Vec3& gravity) const {
  forces.group.clear();
  if (any()) impl_->motions.constrain(forces, caller, gravity);
}

template <class Real>
void Groups<Real>::save(SimulationState& state) const {
  if (any()) impl_->motions.save(state);
}

template <class Real>
void Groups<Real>::restore(const SimulationState& state) {
  if (!any()) {
    if (find_part(state, "groups") != nullptr) throw not_a_state("it has other groups");
    return;
  }
  impl_->motions.restore(state);
  impl_->limits.look_again();
}

template class Groups<double>;
template class Groups<float>;

}  // namespace sinew
