// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/analysis/detail/holding.h>

#include <algorithm>
#include <cstdint>
#include <optional>

#include <sinew/core/cell_grid.h>
#include <sinew/core/decompositions.h>
#include <sinew/world/world.h>

namespace sinew {
namespace {

constexpr double on_axis = 1e-6;  // radii: a particle there has no direction from its bone

Mat3 along(const Vec3& direction) { return direction * direction.transpose(); }

Mat3 springs_of(const BoneSprings& springs, const Influence& by, const Bone& bone, const Vec3& at,
                double radius) {
  if (springs.form == BoneForce::anchor) return springs.radial * Mat3::Identity();
  const Vec3 axis = bone.axis(), out = at - by.foot_on(bone);
  Mat3 sum = springs.axial * along(axis);
  if (out.norm() < on_axis * radius) return sum + springs.radial * Mat3::Identity();
  sum += springs.radial * along(out.normalized());
  const Vec3 turning = axis.cross(out);
  if (springs.twist_form == TwistForm::servo && turning.norm() > on_axis * radius)
    sum += springs.twist * along(turning.normalized());
  return sum;
}

Mat3 freedom(const Pinned& pin) {
  if (pin.is_oblique()) return Mat3::Identity() - along(pin.along);
  Mat3 free = Mat3::Zero();
  for (int axis = 0; axis < 3; ++axis) free(axis, axis) = pin.holds(axis) ? 0 : 1;
  return free;
}

Holding nothing(std::size_t particles) {
  return {std::vector<Mat3>(particles, Mat3::Zero()), std::vector<Mat3>(particles, Mat3::Zero()),
          std::vector<Mat3>(particles, Mat3::Identity())};
}

/// Projector on what both leave free.
Mat3 both(const Mat3& a, const Mat3& b) {
  if (a.isIdentity(0)) return b;
  if (b.isIdentity(0) || a == b) return a;
  const auto [values, axes] = principal_axes(a + b);
  Mat3 common = Mat3::Zero();
  for (int k = 0; k < 3; ++k)
    if (values[k] > 2 - 1e-9) common += along(axes.col(k));
  return common;
}

}  // namespace

Holding Holding::part(const std::vector<std::size_t>& places) const {
  Holding part;
  if (empty()) return part;
  for (const std::size_t i : places) {
    part.springs.push_back(springs[i]);
    part.damping.push_back(damping[i]);
    part.free.push_back(free[i]);
  }
  return part;
}

Holding holding_of(const Body& body) {
  const bool pinned = body.world && !body.world->pins.empty();
  const bool pulled = std::any_of(body.springs.begin(), body.springs.end(),
                                  [](const BoneSprings& bone) { return bone.stiffest() > 0; });
  if (!pinned && !(pulled && !body.binding.influences.empty())) return {};
  Holding holding = nothing(body.rest.size());
  for (std::size_t i = 0; pulled && i < body.rest.size(); ++i)
    for (const Influence& by : body.binding.of(i)) {
      const auto b = static_cast<std::size_t>(by.bone);
      const BoneSprings& springs = body.springs[b];
      if (springs.stiffest() == 0) continue;
      holding.springs[i] += by.weight * springs_of(springs, by, body.skeleton.bones[b],
                                                   body.rest[i], body.material.pair.r);
      holding.damping[i] += by.weight * springs.damping * Mat3::Identity();
    }
  if (pinned)
    for (const Pinned& pin : body.world->pins) holding.free[pin.particle] = freedom(pin);
  return holding;
}

Holding spread_onto(const Points& coarse, double spacing, const Points& rest,
                    const Holding& holding) {
  if (holding.empty()) return {};
  Holding sums = nothing(coarse.size());
  const CellGrid grid(coarse, 2 * spacing);
  for (std::size_t i = 0; i < rest.size(); ++i) {
    std::optional<std::uint32_t> nearest;
    double least = 0;
    grid.for_each_near(rest[i], [&](std::uint32_t j) {
      const double distance = (coarse[j] - rest[i]).squaredNorm();
      if (!nearest || distance < least) nearest = j, least = distance;
    });
    if (!nearest) continue;
    sums.springs[*nearest] += holding.springs[i];
    sums.damping[*nearest] += holding.damping[i];
    sums.free[*nearest] = both(sums.free[*nearest], holding.free[i]);
  }
  return sums;
}

}  // namespace sinew
