// SPDX-License-Identifier: GPL-3.0-or-later
// The room without its contents (SINEW_GROUPS is OFF): no particle is in a group, and who asks for
// groups is told so.
#include <sinew/core/error.h>
#include <sinew/groups/groups.h>
#include <sinew/groups/kept_free.h>
#include <sinew/groups/make_grouping.h>
#include <sinew/groups/static_groups.h>

namespace sinew {
namespace {

[[noreturn]] void refuse() {
  throw bad_input("this sinew was built without groups of particles (SINEW_GROUPS=OFF)",
                  "set hierarchy.enabled to false, or build sinew with -DSINEW_GROUPS=ON");
}

}  // namespace

bool groups_are_built() { return false; }
bool supports_cubic_groups(const Body&) { return false; }
void check_groupable(const Body&) { refuse(); }
void check_groupable_as_it_moves(const Body&) { refuse(); }
Grouping make_grouping(const Body&, std::vector<std::int32_t>, std::size_t, SharedNeighbors) {
  refuse();
}
Grouping static_groups(const Body&, const std::vector<bool>&, const GroupSizes&) { refuse(); }
std::vector<bool> moving_joints(const Skeleton&, const Motion&, double) { refuse(); }
std::vector<std::uint8_t> kept_free(const Body&, const AskedFree&) { refuse(); }
std::vector<std::uint8_t> near_obstacles(const Body&, const Motion&, double) { refuse(); }
std::vector<std::uint8_t> touching_bodies(const Body&, const Motion&, double) { refuse(); }

template <class Real>
struct Groups<Real>::Impl {};

template <class Real>
Groups<Real>::Groups() = default;
template <class Real>
Groups<Real>::Groups(Groups&&) noexcept = default;
template <class Real>
Groups<Real>& Groups<Real>::operator=(Groups&&) noexcept = default;
template <class Real>
Groups<Real>::~Groups() = default;
template <class Real>
Groups<Real>::Groups(std::shared_ptr<const Body> body, double, const kernel::Functions<Real>&) {
  if (body->grouping && body->grouping->size() > 0) refuse();
}
template <class Real>
void Groups<Real>::set_order(std::span<const std::int32_t>, const BondLists<Real>&, bool) {}
template <class Real>
void Groups<Real>::begin(const BlockState<Real>&, const Units&) {}
template <class Real>
void Groups<Real>::watch(const kernel::Lists*, std::span<const std::uint32_t>,
                         const BondLists<Real>&, const std::function<bool(std::size_t)>&) {}
template <class Real>
void Groups<Real>::place(BlockState<Real>&, const Units&) {}
template <class Real>
void Groups<Real>::show_all(BlockState<Real>&, const Units&) {}
template <class Real>
void Groups<Real>::activate(BlockState<Real>&, const Units&) {}
template <class Real>
GroupedParticles Groups<Real>::seen(BlockState<Real>&, const Units&) {
  return {};
}
template <class Real>
bool Groups<Real>::is_idle(std::size_t) const {
  return false;
}
template <class Real>
kernel::Grouped<Real> Groups<Real>::arrays() {
  return {};
}
template <class Real>
void Groups<Real>::step(const BondLists<Real>&, const kernel::Step<Real>&, const Units&,
                        const GroupStep&, const std::function<bool(std::size_t)>&,
                        std::span<kernel::Totals>) {}
template <class Real>
GroupSums Groups<Real>::sums() const {
  return {};
}
template <class Real>
void Groups<Real>::advance() {}
template <class Real>
void Groups<Real>::add_constrained(std::span<const std::int32_t>, const Units&,
                                   std::span<ConstrainedCell>) const {}
template <class Real>
void Groups<Real>::constrain(Forces& forces, const std::vector<std::uint32_t>&, const Vec3&) const {
  forces.group.clear();
}
template <class Real>
void Groups<Real>::save(SimulationState&) const {}
template <class Real>
void Groups<Real>::restore(const SimulationState& state) {
  if (find_part(state, "groups") != nullptr) throw not_a_state("it has other groups");
}

template class Groups<double>;
template class Groups<float>;

}  // namespace sinew
