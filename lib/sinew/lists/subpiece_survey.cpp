// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/lists/subpiece_survey.h>

#include <sinew/core/decompositions.h>

namespace sinew {
namespace {

Vec3 vector(const double (&v)[3]) { return {v[0], v[1], v[2]}; }

/// The sum of (x - mean) (x - mean)^T.
Mat3 spread_of(const kernel::Survey& survey, std::size_t particles) {
  const auto& xx = survey.xx;
  Mat3 all;
  all << xx[0], xx[5], xx[4], xx[5], xx[1], xx[3], xx[4], xx[3], xx[2];
  const Vec3 sum = vector(survey.x);
  return all - sum * sum.transpose() / static_cast<double>(particles);
}

/// The angular velocity of particles with these moments: least squares.
Vec3 spin_of(const Mat3& spread, const Vec3& moment) {
  const double size = spread.trace();
  if (!(size > 0)) return Vec3::Zero();
  // Particles in a line may turn about it at any rate.
  const Mat3 inertia = (1 + 1e-6) * size * Mat3::Identity() - spread;
  const Vec3 spin = inertia.inverse() * moment;
  return spin.allFinite() ? spin : Vec3(Vec3::Zero());
}

Box box_of(const double (&low)[3], const double (&high)[3], double more) {
  return {Vec3(vector(low).array() - more), Vec3(vector(high).array() + more)};
}

}  // namespace

PieceNow motion_of(const kernel::Survey& survey, std::size_t particles, const Vec3& center,
                   const Mat3& axes, double rounding) {
  const auto count = static_cast<double>(particles);
  const Vec3 mean = vector(survey.x) / count, velocity = vector(survey.v) / count;
  const double more =
      2 * rounding * (vector(survey.high).maxCoeff() - vector(survey.low).minCoeff());
  PieceNow now;
  now.box = box_of(survey.low, survey.high, more).translate(center);
  now.center = center;
  now.axes = axes;
  now.along = box_of(survey.low_along, survey.high_along, more);
  now.spin =
      spin_of(spread_of(survey, particles), vector(survey.xv) - count * mean.cross(velocity));
  now.velocity = velocity - now.spin.cross(mean);
  return now;
}

Mat3 axes_of(const kernel::Survey& survey, std::size_t particles) {
  const Mat3 axes = principal_axes(spread_of(survey, particles)).axes;
  return axes.allFinite() ? axes : Mat3(Mat3::Identity());
}

}  // namespace sinew
