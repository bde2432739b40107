// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/stepping/detail/rigid_brakes.h>

#include <sinew/world/references.h>

namespace sinew {

template <class Real>
void RigidBrakes<Real>::set_order(std::span<const std::int32_t> id) {
  if (references_.damping() == nullptr) return;
  references_.set_order(id);
  id_.assign(id.begin(), id.end());
  find_slots();
}

template <class Real>
void RigidBrakes<Real>::find_slots() {
  slots_ = rigid_slots<Real>(*references_.damping(), id_);
}

template <class Real>
void RigidBrakes<Real>::find(std::int64_t steps, const TimedPose& moment, const Stepper& stepper,
                             BlockState<Real>& state, const Units& units) {
  if (references_.damping() == nullptr) return;
  if (references_.follow_cracks(steps, stepper)) find_slots();
  references_.find(moment, state.arrays(), units);
  const auto motions = references_.motions();
  motions_.resize(motions.size());
  for (std::size_t r = 0; r < motions.size(); ++r)
    motions_[r] = motion_now<Real>(motions[r], references_.damping()->references[r].kind, units);
}

template <class Real>
kernel::RigidDamping<Real> RigidBrakes<Real>::arrays(const Units& units) const {
  if (references_.damping() == nullptr) return {};
  return {static_cast<Real>(references_.damping()->rate * units.time), slots_.first.data(),
          slots_.slots.data(), slots_.weights.data(), motions_.data()};
}

template <class Real>
WorldReactions RigidBrakes<Real>::reactions(const BlockState<Real>& state, const Units& units,
                                            double mass) const {
  WorldReactions all;
  if (references_.damping() == nullptr) return all;
  all.pins.resize(body_->skeleton.size());
  all.supports.resize(body_->world ? body_->world->supports.size() : 0);
  for (std::size_t k = 0; k < id_.size(); ++k) {
    const auto id = static_cast<std::size_t>(id_[k]);
    const Vec3 p = state.position(k, units);
    const Vec3 force =
        references_.force(id, mass_of(*body_, id, mass), p, state.velocity(k, units));
    add_reactions(*references_.damping(), id, p, force, references_.motions(), all.pins,
                  all.supports);
  }
  return all;
}

template class RigidBrakes<double>;
template class RigidBrakes<float>;

}  // namespace sinew
