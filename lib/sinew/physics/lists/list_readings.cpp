// SPDX-License-Identifier: GPL-3.0-or-later
// What is read from a list stepper between steps.
#include <sinew/physics/lists/force_probe.h>
#include <sinew/physics/lists/list_stepper.h>

namespace sinew {

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
               stepping_.step / 2 *
                   (forces.total(i) /
                        mass_of(*body_, static_cast<std::size_t>(particles.id[i]), mass_) +
                    stepping_.gravity));
}

template Balance ListStepper<double>::evaluate(const Pose&, Forces&);
template Balance ListStepper<float>::evaluate(const Pose&, Forces&);
template void ListStepper<double>::read(const Pose&, Particles&);
template void ListStepper<float>::read(const Pose&, Particles&);

}  // namespace sinew
