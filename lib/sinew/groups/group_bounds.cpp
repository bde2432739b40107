// SPDX-License-Identifier: GPL-3.0-or-later
// How fast and how much groups move and strain anywhere, at most: from the middles of boxes around
// their particles, and from bounds of second derivatives.
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include <sinew/core/parallel.h>
#include <sinew/groups/groups.h>

namespace sinew {
namespace {

constexpr std::size_t boxes_at_a_time = 64;
// Rates of strain are found once in so many steps; until then they grow by less than this factor.
constexpr int steps_between_rates = 8;
constexpr double rates_ahead = 1.25;

/// Largest sizes of second derivatives within `reach` of the middle.
Mat3 curvature_within(const Coefficients& of, const Vec3& reach) {
  Mat3 all = Mat3::Zero();
  for (int k = affine_terms; k < cubic_terms; ++k) {
    const auto& factors = factors_of_terms[static_cast<std::size_t>(k)];
    const double size = of.row(k).norm();
    for (std::size_t one = 0; one < 3; ++one)
      for (std::size_t other = 0; other < 3; ++other) {
        if (one == other || factors[one] == 3 || factors[other] == 3) continue;
        const int left = factors[3 - one - other];
        all(factors[one], factors[other]) += size * (left == 3 ? 1 : reach[left]);
      }
  }
  return all;
}

/// How much a field whose second derivatives are at most these leaves its tangent in a box.
double beyond_tangent(const Mat3& curvature, const Vec3& half) {
  return half.dot(curvature * half) / 2;
}

/// How much its derivatives change there, times a matrix.
double change_of_slope(const Mat3& curvature, const Vec3& half, const Mat3& times) {
  return (curvature * half).dot(times.rowwise().norm());
}

/// How much the tangent grows.
double along_tangent(const Mat3& slopes, const Vec3& half) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) sum += half[axis] * slopes.col(axis).norm();
  return sum;
}

/// v + w x (x - c) = (v - w x c) + w x x.
struct Field {
  Vec3 velocity, spin;  ///< at the origin
};

template <class Real>
Field field_of(const kernel::RigidMotion<Real>& motion) {
  Vec3 center, velocity, spin;
  for (int axis = 0; axis < 3; ++axis) {
    center[axis] = static_cast<double>(motion.center[axis]);
    velocity[axis] = static_cast<double>(motion.velocity[axis]);
    spin[axis] = static_cast<double>(motion.spin[axis]);
  }
  return {velocity - spin.cross(center), spin};
}

}  // namespace

template <class Real>
auto Groups<Real>::curvature_of(const Shape& shape, const GroupMotion& motion) const -> Curvature {
  if (!shape.cubic) return {};
  return {curvature_within(motion.x, shape.reach), curvature_within(motion.v, shape.reach)};
}

template <class Real>
typename Groups<Real>::LocalMotion Groups<Real>::motion_at(const Shape& shape,
                                                           const GroupMotion& motion,
                                                           const Vec3& at) const {
  if (!shape.cubic)
    return {motion.x.row(0).transpose() + motion.x.middleRows<3>(1).transpose() * at,
            motion.v.row(0).transpose() + motion.v.middleRows<3>(1).transpose() * at,
            motion.x.middleRows<3>(1).transpose(), motion.v.middleRows<3>(1).transpose()};
  const Slopes slopes = slopes_at(at);
  // Too small for Eigen's products of large matrices.
  return {value_at(motion.x, at), value_at(motion.v, at), motion.x.transpose().lazyProduct(slopes),
          motion.v.transpose().lazyProduct(slopes)};
}

/// Relative to the field anywhere in the box, at most, squared.
template <class Real>
double Groups<Real>::fastest_in(const PieceBox& one, const Units& units, const LocalMotion& local,
                                const Curvature& curvature,
                                const kernel::RigidMotion<Real>& motion) const {
  const Field field = field_of(motion);
  const double speed = units.time / units.length;
  const Vec3 half = one.box.sizes() / 2;
  const Vec3 at = (local.x - units.origin) / units.length;
  Mat3 slopes = speed * local.dv;
  for (int axis = 0; axis < 3; ++axis)
    slopes.col(axis) -= field.spin.cross(local.dx.col(axis)) / units.length;
  const Mat3 bends = speed * curvature.v + field.spin.norm() / units.length * curvature.x;
  const double fastest = (speed * local.v - field.velocity - field.spin.cross(at)).norm() +
                         along_tangent(slopes, half) + beyond_tangent(bends, half);
  return fastest * fastest;
}

/// Of its particles, and what is between them in memory.
template <class Real>
double Groups<Real>::fastest_of(const PieceBox& one, const Units& units, const GroupMotion& motion,
                                const kernel::RigidMotion<Real>& rigid) const {
  const Field field = field_of(rigid);
  Mat3 turning;
  const Vec3& spin = field.spin;
  turning << 0, -spin[2], spin[1], spin[2], 0, -spin[0], -spin[1], spin[0], 0;
  Coefficients relative =
      units.time / units.length * motion.v - motion.x * (turning.transpose() / units.length);
  relative.row(0) -= (field.velocity - turning * units.origin / units.length).transpose();
  return kernel_.largest[motions_of(static_cast<std::size_t>(one.group))](
      {one.begin,
       one.end,
       {at_[0].data(), at_[1].data(), at_[2].data()},
       relative.data(),
       at_[0].size()});
}

/// The largest in a box and around it, 1/s.
template <class Real>
double Groups<Real>::strain_rate(const PieceBox& one, const LocalMotion& local,
                                 const Curvature& curvature) const {
  const Vec3& half = one.around;
  const Mat3 back = local.dx.inverse(), L = local.dv * back;
  const double turned = change_of_slope(curvature.x, half, back);
  const double changes = change_of_slope(curvature.v, half, back) + L.norm() * turned;
  return (L + L.transpose()).norm() / 2 + changes / std::max(1 - turned, 0.1);
}

/// Boxes of a piece follow each other. Where no lists depend on strains, and they change
/// slowly, their rates are found now and then.
template <class Real>
void Groups<Real>::bound(const Units& units, const GroupStep& by,
                         const std::function<bool(std::size_t)>& meets,
                         const kernel::Parts<Real>& parts, std::span<kernel::Totals> totals) {
  std::vector<GroupMotion> moving = motions_;
  std::vector<Curvature> curvature(motions_.size());
  std::vector<double> speed2(motions_.size());
  for (std::size_t g = 0; g < moving.size(); ++g) {
    if (!by.drift_first) moving[g].v = next_[g].v;
    curvature[g] = curvature_of(shapes_[g], moving[g]);
    const LocalMotion middle = motion_at(shapes_[g], moving[g], Vec3::Zero());
    const double speed = middle.v.norm() + along_tangent(middle.dv, shapes_[g].reach) +
                         beyond_tangent(curvature[g].v, shapes_[g].reach);
    speed2[g] = std::pow(speed * units.time / units.length, 2);
  }
  const bool everywhere = steps_++ % steps_between_rates == 0;
  rates_.resize(boxes_.size());
  std::vector<double> fastest(boxes_.size());
  parallel_for(boxes_.size(), boxes_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const PieceBox& one = boxes_[k];
      const auto g = static_cast<std::size_t>(one.group);
      const bool near = working_[one.piece] != 0 || meets(one.piece);
      const LocalMotion local = motion_at(shapes_[g], moving[g], one.box.center());
      const auto& field = parts.motions[one.part];
      fastest[k] = near ? fastest_of(one, units, moving[g], field)
                        : fastest_in(one, units, local, curvature[g], field);
      rates_[k] = near || everywhere ? strain_rate(one, local, curvature[g]) : 0;
    }
  });
  for (std::size_t k = 0; k < boxes_.size();) {
    const std::uint32_t piece = boxes_[k].piece;
    const bool near = working_[piece] != 0 || meets(piece);
    double rate = 0;
    for (; k < boxes_.size() && boxes_[k].piece == piece; ++k) {
      rate = std::max(rate, rates_[k]);
      Real& of_part = parts.fastest[boxes_[k].part];
      of_part = std::max(of_part, static_cast<Real>(fastest[k] * (1 + 1e-6)));
      totals[piece].speed2 =
          std::max(totals[piece].speed2, speed2[static_cast<std::size_t>(boxes_[k].group)]);
    }
    strains_[piece] +=
        (near ? 1 : rates_ahead * steps_between_rates) * by.drift * rate * (1 + by.drift * rate);
  }
}

/// The box around the moved box; the rotation of the rate of its deformation.
template <class Real>
PieceNow Groups<Real>::piece_now(std::size_t piece, const Units& units) const {
  const PieceBox& one = boxes_[box_of_[piece]];
  const auto g = static_cast<std::size_t>(one.group);
  const LocalMotion local = motion_at(shapes_[g], motions_[g], one.box.center());
  const Vec3 size = one.box.sizes();
  const double bends =
      beyond_tangent(curvature_of(shapes_[g], motions_[g]).x, size / 2) / units.length;
  PieceNow now;
  now.center = (local.x - units.origin) / units.length;
  const Vec3 half = (local.dx.cwiseAbs() * size / (2 * units.length)).array() + bends;
  const Vec3 more = half + Vec3::Constant(1e-6 * half.maxCoeff() + (sizeof(Real) == 4 ? 1 : 0));
  now.box = Box(Vec3(now.center - more), Vec3(now.center + more));
  now.axes = Eigen::HouseholderQR<Mat3>(local.dx).householderQ();
  const Vec3 along =
      ((now.axes.transpose() * local.dx).cwiseAbs() * size / (2 * units.length)).array() + bends;
  const Vec3 own = along + (more - half);
  now.along = Box(Vec3(-own), own);
  now.velocity = units.time / units.length * local.v;
  const Mat3 L = units.time * local.dv * local.dx.inverse();
  now.spin = Vec3(L(2, 1) - L(1, 2), L(0, 2) - L(2, 0), L(1, 0) - L(0, 1)) / 2;
  return now;
}

template auto Groups<double>::curvature_of(const Shape&, const GroupMotion&) const -> Curvature;
template auto Groups<double>::motion_at(const Shape&, const GroupMotion&, const Vec3&) const
    -> LocalMotion;
template void Groups<double>::bound(const Units&, const GroupStep&,
                                    const std::function<bool(std::size_t)>&,
                                    const kernel::Parts<double>&, std::span<kernel::Totals>);
template PieceNow Groups<double>::piece_now(std::size_t, const Units&) const;
template auto Groups<float>::curvature_of(const Shape&, const GroupMotion&) const -> Curvature;
template auto Groups<float>::motion_at(const Shape&, const GroupMotion&, const Vec3&) const
    -> LocalMotion;
template void Groups<float>::bound(const Units&, const GroupStep&,
                                   const std::function<bool(std::size_t)>&,
                                   const kernel::Parts<float>&, std::span<kernel::Totals>);
template PieceNow Groups<float>::piece_now(std::size_t, const Units&) const;

}  // namespace sinew
