// SPDX-License-Identifier: GPL-3.0-or-later
// What is read from a list stepper between steps, and why one failed.
#include <algorithm>
#include <cmath>

#include <sinew/physics/lists/force_probe.h>
#include <sinew/physics/lists/list_stepper.h>

namespace sinew {

/// The particles that failed, in the caller's order; the fastest one where rounding leaves none.
template <class Real>
Failure ListStepper<Real>::failure(const Pose& pose) {
  Failure failure;
  const double most = most_radii_per_step * body_->material.pair.r *
                      (1 - (sizeof(Real) == 4 ? 1e-5 : 0));  // rounding
  Offender fastest{0, true, -1};
  for (std::size_t k = 0; k < layout_.caller().size(); ++k) {
    if (groups_.is_idle(k)) continue;
    const double moved = stepping_.step * relative_velocity(pose, k).norm();
    const bool finite =
        std::isfinite(moved) && layout_.next.velocity(k, layout_.units()).allFinite();
    const Offender one{layout_.caller()[k], finite, std::isfinite(moved) ? moved : 0};
    if (finite && moved > fastest.moved) fastest = one;
    if (!finite || moved > most) failure.all.push_back(one);
  }
  if (failure.all.empty()) failure.all.push_back(fastest);
  std::sort(failure.all.begin(), failure.all.end(),
            [](const Offender& a, const Offender& b) { return a.particle < b.particle; });
  failure.first = failure.all.front();
  return failure;
}

/// Velocity after the step relative to the leading bone or, without one and for what is held, to
/// the velocity before.
template <class Real>
Vec3 ListStepper<Real>::relative_velocity(const Pose& pose, std::size_t k) const {
  const int bone = body_->binding.bone(static_cast<std::size_t>(layout_.padded_id()[k]));
  const Vec3 carried = bone == no_bone || surroundings_.is_held(k)
                           ? layout_.now.velocity(k, layout_.units())
                           : pose[bone].velocity_at(layout_.now.position(k, layout_.units()));
  return layout_.next.velocity(k, layout_.units()) - carried;
}

template <class Real>
Balance ListStepper<Real>::evaluate(const Pose& pose, Forces& forces) {
  Points of_world;
  const auto now = begin(pose, surroundings_.any() ? &of_world : nullptr, true);
  const double newtons =
      mass_ * layout_.units().length / (layout_.units().time * layout_.units().time);
  const auto work = kernel_.probe[law_][share_.empty() ? kernel::to_the_mean : kernel::pairwise];
  const ForceProbe<Real> probe(work, now, layout_, newtons, has_muscles(*body_), of_world);
  resize(forces, layout_.size(), body_->world != nullptr || surroundings_.any());
  on_all_pieces([&](std::size_t first, std::size_t last) { probe(first, last, forces); });
  groups_.constrain(forces, layout_.caller(), stepping_.gravity);
  const StepSums sums = sums_of_totals();
  Balance balance{sums.power, sums.lost, 0, 0, sums.world_power, 0, sums.held_kinetic};
  balance.contact_energy = surroundings_.sums().contact_energy;
  const double joules = newtons * layout_.units().length;
  for (const kernel::Totals& piece : totals_) {
    balance.pair_energy += joules * piece.pair_energy;
    balance.bone_energy += joules * piece.bone_energy;
  }
  return balance;
}

template <class Real>
void ListStepper<Real>::read(const Pose& pose, Particles& particles) {
  hold(pose);
  groups_.show_all(layout_.now, layout_.units());
  layout_.read(particles);
  if (stepping_.integrator != Integrator::velocity_verlet || !kicked_) return;
  Forces forces;
  evaluate(pose, forces);
  for (std::size_t i = 0; i < particles.size(); ++i)
    particles.set_velocity(
        i, particles.velocity(i) +
               stepping_.step / 2 * (forces.total(i) / particles.mass + stepping_.gravity));
}

template Failure ListStepper<double>::failure(const Pose&);
template Failure ListStepper<float>::failure(const Pose&);
template Balance ListStepper<double>::evaluate(const Pose&, Forces&);
template Balance ListStepper<float>::evaluate(const Pose&, Forces&);
template void ListStepper<double>::read(const Pose&, Particles&);
template void ListStepper<float>::read(const Pose&, Particles&);

}  // namespace sinew
