// SPDX-License-Identifier: GPL-3.0-or-later
// What went wrong in a step.
#include <algorithm>
#include <cmath>

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

template Failure ListStepper<double>::failure(const Pose&);
template Failure ListStepper<float>::failure(const Pose&);

}  // namespace sinew
