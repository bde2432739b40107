// SPDX-License-Identifier: GPL-3.0-or-later
// Steps of a relaxation: see ../relaxation.h.
#include <algorithm>

#include <sinew/physics/lists/list_stepper.h>

namespace sinew {

template <class Real>
StepSums ListStepper<Real>::try_step(const Pose& pose, double keep) {
  auto now = begin(pose, nullptr, false);
  now.relaxes = true;
  now.keep = static_cast<Real>(keep);
  now.kick = static_cast<Real>(stepping_.step / layout_.units().time * (1 + keep) / 2);
  StepSums sums = run(now, pose);
  sums.imbalance = imbalance();
  return sums;
}

template <class Real>
void ListStepper<Real>::halt() {
  layout_.now.halt();
}

template <class Real>
Imbalance ListStepper<Real>::imbalance() const {
  const double L = layout_.units().length, T = layout_.units().time;
  Imbalance sum;
  double pulled = 0;
  for (const kernel::Totals& piece : totals_) {  // in this order, whichever thread made them
    sum.aa += piece.relaxing.aa;
    sum.av += piece.relaxing.av;
    sum.vv += piece.relaxing.vv;
    sum.unbalanced += piece.relaxing.unbalanced;
    pulled += piece.relaxing.pulled;
    sum.flowing += piece.lost;
  }
  sum.aa *= L * L / (T * T * T * T);
  sum.av *= L * L / (T * T * T);
  sum.vv *= L * L / (T * T);
  const double newtons = mass_ * L / (T * T);
  sum.flowing *= newtons * L / T;
  sum.unbalanced *= newtons;
  const double weight = total_mass(*body_, mass_) * stepping_.gravity.norm();
  const double loaded = surroundings_.loaded();
  sum.applied = std::max({newtons * pulled / 2, surroundings_.sums().applied + loaded, weight});
  sum.loaded = loaded + weight;
  for (const Reaction& support : surroundings_.of_supports())
    sum.applied = std::max({sum.applied, support.force.norm(), support.moment.norm() / extent_});
  return sum;
}

template StepSums ListStepper<double>::try_step(const Pose&, double);
template StepSums ListStepper<float>::try_step(const Pose&, double);
template void ListStepper<double>::halt();
template void ListStepper<float>::halt();

}  // namespace sinew
