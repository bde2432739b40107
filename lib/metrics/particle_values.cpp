// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/particle_values.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/cell_grid.h"
#include "core/closest_packing.h"
#include "core/parallel.h"

namespace sinew {
namespace {

constexpr std::size_t piece = 1024;
constexpr double flattest = 1e-24;  // squared stretch: keeps the logarithm of a flat F finite

template <class Job>
void for_each_particle(std::size_t count, const Job& job) {
  parallel_for(count, piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) job(i);
  });
}

/// sqrt(factor dev T : dev T) of a symmetric tensor with these principal values.
double equivalent(const Vec3& principal, double factor) {
  const double mean = principal.mean();
  return std::sqrt(factor * (principal.array() - mean).square().sum());
}

double von_mises(const Mat3& stress) {
  const Mat3 deviator = stress - stress.trace() / 3 * Mat3::Identity();
  return std::sqrt(1.5 * deviator.squaredNorm());
}

double non_affine(const RestShape& shape, const Points& now, const Mat3& F, std::size_t i) {
  double sum = 0;
  const auto partners = shape.neighbours.of(i);
  for (const auto j : partners)
    sum += ((now[j] - now[i]) - F * (shape.points[j] - shape.points[i])).squaredNorm();
  return sum / static_cast<double>(partners.size());
}

void add_motion(ParticleValues& out, const RestBody& rest, const FrameState& state) {
  for_each_particle(rest.particles(), [&](std::size_t i) {
    out.displacement[i] = (state.positions[i] - rest.shape.points[i]).norm();
    out.speed[i] = state.velocities[i].norm();
  });
}

void add_deformation(ParticleValues& out, const RestShape& shape, const Points& now) {
  for_each_particle(now.size(), [&](std::size_t i) {
    out.J[i] = out.strain[i] = out.stretch[i] = out.D2min[i] = not_measured;
    if (!shape.defined(i)) return;
    const Mat3 F = deformation_gradient(shape, now, i);
    Eigen::SelfAdjointEigenSolver<Mat3> principal;
    principal.computeDirect(F.transpose() * F, Eigen::EigenvaluesOnly);
    const Vec3 squares = principal.eigenvalues().cwiseMax(flattest);
    out.J[i] = F.determinant();
    out.strain[i] = equivalent(squares.array().log() / 2, 2.0 / 3);
    out.stretch[i] = std::sqrt(squares.maxCoeff());
    out.D2min[i] = non_affine(shape, now, F, i);
  });
}

void add_surroundings(ParticleValues& out, const RestBody& rest, const Points& now) {
  const double near = rest_neighbour_range(rest.radius), far = rest.interaction_range;
  const double twice_volume = 2 * volume_per_particle(rest.radius);
  const CellGrid grid(now, std::max(near, far));
  for_each_particle(now.size(), [&](std::size_t i) {
    Mat3 virial = Mat3::Zero();
    grid.for_each_near(now[i], [&](std::uint32_t j) {
      const Vec3 apart = now[i] - now[j];
      const double squared = apart.squaredNorm();
      if (j == i || squared >= std::max(near * near, far * far)) return;
      out.near[i] += squared < near * near;
      out.neighbours[i] += squared < far * far;
      if (const double d = std::sqrt(squared); rest.pair_force && d > 0)
        virial -= rest.pair_force(d) / d * apart * apart.transpose();
    });
    if (rest.pair_force) out.von_mises[i] = von_mises(virial / twice_volume);
  });
}

}  // namespace

ParticleValues particle_values(const RestBody& rest, const FrameState& state) {
  ParticleValues out;
  const std::size_t n = rest.particles();
  for (auto* values : {&out.displacement, &out.speed, &out.J, &out.strain, &out.stretch, &out.D2min,
                       &out.neighbours, &out.near})
    values->resize(n);
  if (rest.pair_force) out.von_mises.resize(n);
  add_motion(out, rest, state);
  add_deformation(out, rest.shape, state.positions);
  add_surroundings(out, rest, state.positions);
  return out;
}

}  // namespace sinew
