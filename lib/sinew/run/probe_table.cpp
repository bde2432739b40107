// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/run/probe_table.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <sinew/core/decompositions.h>
#include <sinew/core/text.h>

namespace sinew {
namespace {

constexpr const char* probe_columns =
    "time,name,x,y,z,displacement_x,displacement_y,displacement_z,strain_xx,strain_yy,strain_zz,"
    "strain_xy,strain_yz,strain_xz,stress_xx,stress_yy,stress_zz,stress_xy,stress_yz,stress_xz,"
    "force_x,force_y,force_z";

constexpr std::size_t components = 6;  // components of a symmetric tensor
using Tensor = std::array<double, components>;

/// The mean of the tensors that are known, by weight; not-a-number without any.
Tensor mean_tensor(const Probe& probe, std::span<const double> values) {
  Tensor mean{};
  double weights = 0;
  for (std::size_t n = 0; n < probe.particles.size(); ++n) {
    const double* own = values.data() + components * probe.particles[n];
    if (std::isnan(own[0])) continue;
    weights += probe.weight[n];
    for (std::size_t k = 0; k < components; ++k) mean[k] += probe.weight[n] * own[k];
  }
  for (double& value : mean)
    value = weights > 0 ? value / weights : std::numeric_limits<double>::quiet_NaN();
  return mean;
}

Vec3 weighted(const Probe& probe, const Points& values) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t n = 0; n < probe.particles.size(); ++n)
    sum += probe.weight[n] * values[probe.particles[n]];
  return sum;
}

Vec3 force_on(const Probe& probe, const Points& force) {
  Vec3 sum = Vec3::Zero();
  if (force.empty() || probe.is_point) return sum;
  for (const std::uint32_t i : probe.particles) sum += force[i];
  return sum;
}

Mat3 matrix_of(std::span<const double, components> t) {
  Mat3 matrix;
  matrix << t[0], t[3], t[5], t[3], t[1], t[4], t[5], t[4], t[2];
  return matrix;
}

/// Young's modulus asked for at all particles of a probe.
std::optional<double> modulus_asked(const Body& body, const Probe& probe) {
  const auto differs = [&](std::uint32_t i) { return body.stiffness[i] != 1; };
  if (!body.stiffness.empty() &&
      std::any_of(probe.particles.begin(), probe.particles.end(), differs))
    return std::nullopt;
  return body.material.young_modulus();
}

}  // namespace

std::optional<std::pair<double, double>> uniaxial(std::span<const double, 6> stress,
                                                  std::span<const double, 6> strain) {
  constexpr double beside = 0.05, smallest_strain = 1e-5;  // values that single precision resolves
  const Mat3 of_stress = matrix_of(stress), of_strain = matrix_of(strain);
  if (!of_stress.allFinite() || !of_strain.allFinite()) return std::nullopt;
  Vec3 s = eigenvalues(of_stress);
  const Vec3 e = eigenvalues(of_strain);
  if (-s[0] > s[2]) std::swap(s[0], s[2]);  // the largest by size is the last
  const double mises = std::sqrt(((s[0] - s[1]) * (s[0] - s[1]) + (s[1] - s[2]) * (s[1] - s[2]) +
                                  (s[2] - s[0]) * (s[2] - s[0])) /
                                 2);
  const double along = s[2] > 0 ? e[2] : e[0];
  const double stretch = std::sqrt(std::max(0.0, 1 + 2 * along)) - 1;
  const bool pure = std::max(std::abs(s[0]), std::abs(s[1])) <= beside * mises;
  if (!pure || !(std::abs(stretch) > smallest_strain) || stretch * s[2] < 0) return std::nullopt;
  return std::pair(s[2], stretch);
}

ProbeTable::ProbeTable(const std::filesystem::path& path, std::vector<Probe> probes,
                       std::size_t kept)
    : probes_(std::move(probes)), table_(path, probe_columns, probes_.size(), kept) {}

void ProbeTable::add(double time, const Points& positions, const Points& rest,
                     const ProbedValues& values) {
  std::string rows;
  last_.clear();
  for (const Probe& probe : probes_) {
    rows += number_text(time) + ',' + csv_cell(probe.name);
    const Vec3 place = weighted(probe, positions);
    add_cells(place, rows);
    add_cells(place - weighted(probe, rest), rows);
    last_.push_back({mean_tensor(probe, values.strain), mean_tensor(probe, values.stress)});
    for (const Tensor& tensor : last_.back())
      for (const double value : tensor) {
        if (std::isnan(value)) unknown_.insert(probe.name);
        add_cell(value, rows);
      }
    add_cells(force_on(probe, values.force), rows);
    rows += '\n';
  }
  table_.add(rows);
}

std::vector<ShownModulus> ProbeTable::moduli(const Body& body) const {
  std::vector<ShownModulus> all;
  for (std::size_t k = 0; k < last_.size(); ++k)
    if (const auto found = uniaxial(last_[k][1], last_[k][0]))
      all.push_back(
          {probes_[k].name, found->first, found->second, modulus_asked(body, probes_[k])});
  return all;
}

}  // namespace sinew
