// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/fill/moments.h>

#include <cmath>

#include <sinew/core/decompositions.h>

namespace sinew {
namespace {

/// The inertia from second moments: integral of (x.x 1 - x x^T).
Mat3 inertia_of(const Mat3& second) { return second.trace() * Mat3::Identity() - second; }

}  // namespace

Vec3 Moments::principal() const { return eigenvalues(inertia); }

Moments moments_of(const Triangles& surface) {
  const Vec3 middle = bounds(surface.points).center();  // preserves precision far from the origin
  Moments sum;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  for (const auto& [i, j, k] : surface.faces) {
    const Vec3 a = surface.points[i] - middle, b = surface.points[j] - middle,
               c = surface.points[k] - middle;
    const double part = a.dot(b.cross(c)) / 6;
    const Vec3 corners = a + b + c;
    sum.volume += part;
    first += part / 4 * corners;
    second +=
        part / 20 *
        (a * a.transpose() + b * b.transpose() + c * c.transpose() + corners * corners.transpose());
  }
  if (sum.volume == 0) return {0, middle, Mat3::Zero()};
  const Vec3 offset = first / sum.volume;
  sum.center = middle + offset;
  sum.inertia = inertia_of(second - sum.volume * offset * offset.transpose());
  return sum;
}

Moments moments_of(const Particles& particles, double volume) {
  Moments sum;
  const auto count = static_cast<double>(particles.size());
  sum.volume = count * volume;
  for (std::size_t i = 0; i < particles.size(); ++i) sum.center += particles.position(i);
  sum.center /= count;
  Mat3 second = Mat3::Zero();
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const Vec3 from = particles.position(i) - sum.center;
    second += from * from.transpose();
  }
  const double ball = std::cbrt(volume * 3 / (4 * pi));
  sum.inertia = volume * inertia_of(second + count / 5 * ball * ball * Mat3::Identity());
  return sum;
}

}  // namespace sinew
