// SPDX-License-Identifier: GPL-3.0-or-later
// The velocity fields of the parts of neighbor lists: found now and then, and how far particles of
// each may have moved from them in a step.
#include <sinew/physics/lists/verlet_lists.h>

#include <cmath>
#include <utility>

#include <sinew/core/parallel.h>
#include <sinew/physics/lists/part_survey.h>

namespace sinew {
namespace {

constexpr std::size_t parts_at_a_time = 4;

/// Of the kernel's velocity fields, as a share of their speed.
template <class Real>
constexpr double rounding = sizeof(Real) == 4 ? 1e-6 : 1e-14;

}  // namespace

/// Of a part, at its places.
template <class Real>
PieceNow VerletLists<Real>::survey(std::size_t part, BlockState<Real>& state) {
  const auto arrays = state.arrays();
  const std::size_t begin = of_.first[part], end = of_.first[part + 1];
  kernel::SurveyInput<Real> input{arrays, begin, end, {}};
  for (int k = 0; k < 3; ++k)
    for (int axis = 0; axis < 3; ++axis)
      input.axes[k][axis] = static_cast<Real>(axes_[part](axis, k));
  auto& center = motions_[part].center;
  for (int axis = 0; axis < 3; ++axis) center[axis] = arrays.x[axis][(begin + end) / 2];
  const Vec3 middle(static_cast<double>(center[0]), static_cast<double>(center[1]),
                    static_cast<double>(center[2]));
  const kernel::Survey found = kernel_.survey(input, center);
  return motion_of(found, end - begin, middle,
                   std::exchange(axes_[part], axes_of(found, end - begin)), rounding<Real>);
}

/// Finds out how all parts move.
template <class Real>
void VerletLists<Real>::survey(BlockState<Real>& state, const GroupedParticles& groups) {
  std::vector<PieceNow> parts(of_.size());
  const auto is_of_group = [&](std::size_t part) {
    return !groups.of_piece.empty() && groups.of_piece[of_.piece[part]] >= 0;
  };
  std::vector<std::uint32_t> others;
  for (std::uint32_t part = 0; part < parts.size(); ++part)
    if (!is_of_group(part)) others.push_back(of_.piece[part]);
  groups.show(others);
  parallel_for(parts.size(), parts_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t part = begin; part < end; ++part) {
      auto& motion = motions_[part];
      PieceNow& now = parts[part];
      now = is_of_group(part) ? groups.piece_now(of_.piece[part]) : survey(part, state);
      for (int axis = 0; axis < 3; ++axis) {
        motion.velocity[axis] = static_cast<Real>(now.velocity[axis]);
        motion.spin[axis] = static_cast<Real>(now.spin[axis]);
        now.velocity[axis] = static_cast<double>(motion.velocity[axis]);
        now.spin[axis] = static_cast<double>(motion.spin[axis]);
      }
      centers_[part] = now.center;
      place_field(part, now.center);
      speed_[part] = now.velocity.norm() + now.spin.norm() * now.box.diagonal().norm();
    }
  });
  near_.survey(std::move(parts), time_);
  elapsed_ = 0;
  ++counts_.surveys;
}

template <class Real>
void VerletLists<Real>::place_field(std::size_t part, const Vec3& at) {
  for (int axis = 0; axis < 3; ++axis)
    if constexpr (sizeof(Real) == 4)
      motions_[part].center[axis] =
          static_cast<std::int32_t>(static_cast<std::int64_t>(std::nearbyint(at[axis])));
    else
      motions_[part].center[axis] = at[axis];
}

/// The velocity fields travel with the common velocity.
template <class Real>
void VerletLists<Real>::move_fields() {
  elapsed_ += time_;
  for (std::size_t part = 0; part < motions_.size(); ++part)
    place_field(part, centers_[part] + elapsed_ * near_.common_velocity());
}

/// How much faster than by a rigid motion particles within reach of each other may part, since a
/// step takes them along straight lines.
template <class Real>
double VerletLists<Real>::lengthening(std::size_t part) const {
  const Eigen::Map<const Eigen::Matrix<Real, 3, 1>> spin(motions_[part].spin);
  return spin.template cast<double>().squaredNorm() * time_ / 2 * ranges_.outer;
}

/// In the last step, relative to their fields, at most.
template <class Real>
std::vector<double> VerletLists<Real>::fastest_of_parts() const {
  // Fixed-point coordinates are rounded to the nearest unit along each axis, and so are the centers
  // of the velocity fields.
  const double unit = sizeof(Real) == 4 ? 2 / time_ : 0;
  std::vector<double> fastest(of_.size());
  for (std::size_t part = 0; part < fastest.size(); ++part)
    fastest[part] = std::sqrt(static_cast<double>(fastest_[part])) * (1 + 1e-5) + unit +
                    rounding<Real> * speed_[part] + (looks_ ? lengthening(part) : 0);
  return fastest;
}

template void VerletLists<double>::survey(BlockState<double>&, const GroupedParticles&);
template void VerletLists<float>::survey(BlockState<float>&, const GroupedParticles&);
template void VerletLists<double>::move_fields();
template void VerletLists<float>::move_fields();
template std::vector<double> VerletLists<double>::fastest_of_parts() const;
template std::vector<double> VerletLists<float>::fastest_of_parts() const;

}  // namespace sinew
