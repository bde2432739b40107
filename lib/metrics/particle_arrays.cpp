// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/particle_arrays.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"
#include "metrics/particle_values.h"

namespace sinew {
namespace {

constexpr std::size_t piece = 1024;

template <std::size_t n>
using Values = std::array<double, n>;

Values<6> symmetric(const Mat3& T) {
  return {T(0, 0), T(1, 1), T(2, 2), T(0, 1), T(1, 2), T(0, 2)};
}

Values<9> row_by_row(const Mat3& T) {
  Values<9> out;
  for (std::size_t k = 0; k < 9; ++k)
    out[k] = T(static_cast<Eigen::Index>(k / 3), static_cast<Eigen::Index>(k % 3));
  return out;
}

/// of(i), n numbers, for every particle.
template <std::size_t n, class Of>
Column filled(std::string_view name, std::size_t particles, const Of& of) {
  std::vector<double> values(n * particles);
  parallel_for(particles, piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Values<n> one = of(i);
      std::copy(one.begin(), one.end(), values.begin() + static_cast<std::ptrdiff_t>(n * i));
    }
  });
  return {std::string(name), static_cast<int>(n), std::move(values)};
}

/// The same of the deformation gradient, where there is one.
template <std::size_t n, class Of>
Column of_gradient(std::string_view name, const RestBody& rest, const Points& now, const Of& of) {
  Values<n> none;
  none.fill(not_measured);
  return filled<n>(name, now.size(), [&](std::size_t i) {
    return rest.shape.defined(i) ? of(deformation_gradient(rest.shape, now, i)) : none;
  });
}

/// Principal values of F^T F, ascending, with their directions.
Eigen::SelfAdjointEigenSolver<Mat3> right_cauchy_green(const Mat3& F) {
  return Eigen::SelfAdjointEigenSolver<Mat3>(F.transpose() * F);
}

Values<3> stretches(const Mat3& F) {
  const Vec3 squares = right_cauchy_green(F).eigenvalues().cwiseMax(flattest);
  return {std::sqrt(squares[2]), std::sqrt(squares[1]), std::sqrt(squares[0])};
}

Values<6> green_lagrange(const Mat3& F) {
  return symmetric((F.transpose() * F - Mat3::Identity()) / 2);
}

Values<6> hencky(const Mat3& F) {
  const auto principal = right_cauchy_green(F);
  const Vec3 logs = principal.eigenvalues().cwiseMax(flattest).array().log() / 2;
  const Mat3& directions = principal.eigenvectors();
  return symmetric(directions * logs.asDiagonal() * directions.transpose());
}

Column stresses(std::string_view name, const RestBody& rest, const Points& now) {
  Values<6> none;
  none.fill(not_measured);
  if (!rest.law.force) return filled<6>(name, now.size(), [&](std::size_t) { return none; });
  const CellGrid grid(now, rest.interaction_range);
  return filled<6>(name, now.size(), [&](std::size_t i) {
    std::vector<Partner> partners;
    find_partners(now, grid, rest.interaction_range, i, partners);
    return symmetric(virial_stress(rest, now, partners, i));
  });
}

Column inverted(std::string_view name, const std::vector<double>& J) {
  std::vector<std::int32_t> flags;
  for (const double one : J) flags.push_back(one <= 0);
  return column(std::string(name), std::move(flags));
}

/// One of those that frames are measured with.
Column scalar(std::string_view name, const ParticleValues& values) {
  using V = ParticleValues;
  constexpr std::array<std::pair<std::string_view, std::vector<double> V::*>, 6> members{
      {{"J", &V::J},
       {"strain_eq", &V::strain},
       {"von_mises", &V::von_mises},
       {"D2min", &V::D2min},
       {"turnover", &V::turnover},
       {"pose_error", &V::pose_error}}};
  if (name == "inverted") return inverted(name, values.J);
  const auto* member = std::find_if(members.begin(), members.end(),
                                    [&](const auto& one) { return one.first == name; });
  std::vector<double> copy = values.*member->second;
  copy.resize(values.J.size(), not_measured);  // stresses that are not known
  return column(std::string(name), std::move(copy));
}

}  // namespace

std::vector<Column> particle_arrays(const RestBody& rest, const FrameState& state,
                                    std::span<const std::string_view> names) {
  const Points& now = state.positions;
  std::vector<Column> columns;
  ParticleValues values;
  for (const std::string_view name : names) {
    if (name == "F")
      columns.push_back(of_gradient<9>(name, rest, now, row_by_row));
    else if (name == "stretch")
      columns.push_back(of_gradient<3>(name, rest, now, stretches));
    else if (name == "strain")
      columns.push_back(of_gradient<6>(name, rest, now, green_lagrange));
    else if (name == "hencky_strain")
      columns.push_back(of_gradient<6>(name, rest, now, hencky));
    else if (name == "stress")
      columns.push_back(stresses(name, rest, now));
    else {
      if (values.J.empty()) values = particle_values(rest, state);
      columns.push_back(scalar(name, values));
    }
  }
  return columns;
}

}  // namespace sinew
