// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/run/probe_table.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <sinew/core/text.h>

namespace sinew {
namespace {

constexpr const char* probe_columns =
    "time,name,x,y,z,displacement_x,displacement_y,displacement_z,strain_xx,strain_yy,strain_zz,"
    "strain_xy,strain_yz,strain_xz,stress_xx,stress_yy,stress_zz,stress_xy,stress_yz,stress_xz,"
    "force_x,force_y,force_z";

constexpr std::size_t components = 6;  // of a symmetric tensor
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

}  // namespace

ProbeTable::ProbeTable(const std::filesystem::path& path, std::vector<Probe> probes,
                       std::size_t kept)
    : probes_(std::move(probes)), table_(path, probe_columns, probes_.size(), kept) {}

void ProbeTable::add(double time, const Points& positions, const Points& rest,
                     const ProbedValues& values) {
  std::string rows;
  for (const Probe& probe : probes_) {
    rows += number_text(time) + ',' + csv_cell(probe.name);
    const Vec3 place = weighted(probe, positions);
    add_cells(place, rows);
    add_cells(place - weighted(probe, rest), rows);
    for (const auto& tensors : {values.strain, values.stress})
      for (const double value : mean_tensor(probe, tensors)) {
        if (std::isnan(value)) unknown_.insert(probe.name);
        add_cell(value, rows);
      }
    add_cells(force_on(probe, values.force), rows);
    rows += '\n';
  }
  table_.add(rows);
}

}  // namespace sinew
