// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/body/solid.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include <sinew/body/pair_pass.h>
#include <sinew/body/volume_weights.h>
#include <sinew/core/particles.h>
#include <sinew/core/simulation_state.h>
#include <sinew/material/laws.h>

namespace sinew {

namespace {

constexpr std::uint32_t none = 0xffffffff;
constexpr double strain_per_stress = 7.5;  // D over dev T

/// Index of j among the neighbors of i.
std::uint32_t entry_of(const Bonds& bonds, std::size_t i, std::uint32_t j) {
  const auto begin = bonds.neighbors.neighbor.begin();
  const auto last = begin + bonds.neighbors.first[i + 1];
  const auto found = std::lower_bound(begin + bonds.neighbors.first[i], last, j);
  return found != last && *found == j ? static_cast<std::uint32_t>(found - begin) : none;
}

/// The pairs of `near` at rest distances in [from, to), as bonds of that stiffness (N/m).
Bonds bonds_between(const Points& rest, const NeighborLists& near, double from, double to,
                    double stiffness) {
  Bonds bonds;
  bonds.broken.assign(rest.size(), 0);
  bonds.neighbors.first.push_back(0);
  for (std::size_t i = 0; i < rest.size(); ++i) {
    for (const std::uint32_t j : near.of(i)) {
      const double length = (rest[i] - rest[j]).norm();
      if (length < from || length >= to) continue;
      bonds.neighbors.neighbor.push_back(j);
      bonds.rest_length.push_back(length);
      bonds.stiffness.push_back(stiffness);
    }
    bonds.neighbors.first.push_back(static_cast<std::uint32_t>(bonds.neighbors.neighbor.size()));
  }
  return bonds;
}

void apply(const BondFactors& factors, std::span<const std::int32_t> id, Bonds& bonds) {
  for (std::size_t i = 0; i < id.size(); ++i) {
    const BondFactors::Row row = factors.of(static_cast<std::uint32_t>(id[i]));
    for (std::uint32_t e = bonds.neighbors.first[i]; e < bonds.neighbors.first[i + 1]; ++e)
      bonds.stiffness[e] *= row.at(static_cast<std::uint32_t>(id[bonds.neighbors.neighbor[e]]));
  }
}

}  // namespace

bool Bonds::bonded(std::size_t i, std::uint32_t j) const {
  const std::uint32_t entry = entry_of(*this, i, j);
  return entry != none && whole(entry);
}

SolidBonds make_bonds(const Points& rest, const NeighborLists& near, const Material& material,
                      std::span<const std::int32_t> id, const BondFactors& factors) {
  const double r = material.pair.r, between = rest_neighbor_range(r);
  const double far = material.bond.second > 0 ? second_neighbor_range * r : between;
  SolidBonds bonds = {bonds_between(rest, near, 0, between, material.bond.stiffness),
                      bonds_between(rest, near, between, far, material.bond.second)};
  apply(factors, id, bonds.nearest);
  apply(factors, id, bonds.second);
  return bonds;
}

namespace {

Mat3 cofactors(const Mat3& F) {
  Mat3 cof;
  cof.col(0) = F.col(1).cross(F.col(2));
  cof.col(1) = F.col(2).cross(F.col(0));
  cof.col(2) = F.col(0).cross(F.col(1));
  return cof;
}

Mat3 spread_at_rest(const Points& rest, const NeighborLists& neighbors, std::size_t i) {
  Mat3 A = Mat3::Zero();
  for (const std::uint32_t j : neighbors.of(i)) {
    const Vec3 X = rest[j] - rest[i];
    A += X * X.transpose();
  }
  return A;
}

}  // namespace

bool remembers_neighbors(const Material& material) { return law_of(material).has_memory; }

namespace {

/// Puts the values into the order of the particles.
LocalStrength in_order(const LocalStrength& local, std::span<const std::int32_t> id) {
  LocalStrength ordered;
  for (const auto list : {&LocalStrength::volume, &LocalStrength::breaking, &LocalStrength::yield})
    for (std::size_t i = 0; i < id.size() && !(local.*list).empty(); ++i)
      (ordered.*list).push_back((local.*list)[static_cast<std::size_t>(id[i])]);
  return ordered;
}

}  // namespace

Solid::Solid(const Material& material, Points rest, std::span<const std::int32_t> id,
             const BondFactors& factors, const LocalStrength& local, Passing passing)
    : material_(material),
      law_(&law_of(material)),
      pass_(std::move(passing)),
      rest_(std::move(rest)),
      bonds_(make_bonds(rest_,
                        rest_neighbors(rest_, material.pair.r, material.bond.second > 0).all(),
                        material, id, factors)),
      branches_(material.bond, bonds_.nearest.neighbors.neighbor.size(),
                bonds_.second.neighbors.neighbor.size()),
      local_(in_order(local, id)) {
  const std::size_t n = rest_.size();
  if (largest_of(local_.volume, material_.volume_stiffness) <= 0) return;
  local_.volume.resize(n, material_.volume_stiffness);
  inverse_.assign(n, Mat3::Zero());
  weight_.assign(n, 0);
  volume_.assign(n, 0);
  thrust_.assign(n, Mat3::Zero());
  for_each_particle(n, [&](std::size_t i) {
    const Mat3 A = spread_at_rest(rest_, bonds_.nearest.neighbors, i);
    weight_[i] = factors.volume_weight.empty() || id.empty()
                     ? volume_weight(A, material_.pair.r)
                     : factors.volume_weight[static_cast<std::size_t>(id[i])];
    if (weight_[i] > 0) inverse_[i] = A.inverse();
  });
}

double Solid::free_length(bool nearest, std::uint32_t entry) const {
  const Bonds& bonds = nearest ? bonds_.nearest : bonds_.second;
  double length = bonds.rest_length[entry];
  for (const Branches::One& one : (nearest ? branches_.nearest : branches_.second).all)
    length += one.modulus_ratio * one.stretch[entry];
  return length;
}

/// Calls visit(BondNow) for what is still bonded to particle i: by bonds to nearest neighbors that
/// are whole; in the paper's model neighbors at rest within the range of attraction.
template <class Visit>
void Solid::for_each_bonded(const Particles& particles, std::size_t i, const Visit& visit) const {
  for_each_bond(bonds_.nearest, particles, i, [&](const BondNow& bond) {
    if (law_->has_bonds || bond.distance < material_.pair.b) visit(bond);
  });
}

/// Calls visit(j, offset, d) for all others that it touches.
template <class Visit>
void Solid::for_each_touched(const Particles& particles, const CellGrid& cells, std::size_t i,
                             const Visit& visit) const {
  for_each_neighbor(particles, cells, law_->range(material_), i,
                    [&](std::uint32_t j, const Vec3& offset, double d) {
                      if (!bonds_.nearest.bonded(i, j) && !(pass_ && pass_(i, j)))
                        visit(j, offset, d);
                    });
}

/// F_i, J_i and the stress that keeps the volume. Where a bond broke, the body is severed and keeps
/// no volume.
void Solid::find_volumes(const Particles& particles) {
  if (local_.volume.empty()) return;
  const double V0 = volume_per_particle(material_.pair.r);
  for_each_particle(rest_.size(), [&](std::size_t i) {
    thrust_[i].setZero();
    volume_[i] = 0;
    if (weight_[i] == 0 || broken(i) > 0) return;
    Mat3 moved = Mat3::Zero();
    for (const std::uint32_t j : bonds_.nearest.neighbors.of(i))
      moved += (particles.position(j) - particles.position(i)) * (rest_[j] - rest_[i]).transpose();
    const Mat3 F = moved * inverse_[i];
    volume_[i] = F.determinant() - 1;
    thrust_[i] = local_.volume[i] * V0 * weight_[i] * volume_[i] * (cofactors(F) * inverse_[i]);
  });
}

/// Adds up the forces of its own volume and those of its neighbors.
Vec3 Solid::volume_force(std::size_t i) const {
  Vec3 force = Vec3::Zero();
  for (const std::uint32_t j : bonds_.nearest.neighbors.of(i))
    force += (thrust_[i] + thrust_[j]) * (rest_[j] - rest_[i]);
  return force;
}

double Solid::volume_energy(std::size_t i) const {
  return local_.volume[i] / 2 * volume_per_particle(material_.pair.r) * weight_[i] * volume_[i] *
         volume_[i];
}

void Solid::add_springs_of_second(const Particles& particles, Forces& forces) const {
  if (bonds_.second.size() == 0) return;
  for_each_particle(particles.size(), [&](std::size_t i) {
    for_each_bond(bonds_.second, particles, i, [&](const BondNow& bond) {
      const BondSpring spring = branches_.second.with(bond.spring, bond.entry);
      forces.pair[i] += law_->bond_force(material_, spring, bond.distance) *
                        direction_from(particles, bond.offset, bond.distance, i, bond.neighbor);
    });
  });
}

void Solid::forces(const Particles& particles, Forces& forces) {
  const CellGrid cells = cells_of(particles, law_->range(material_));
  const auto for_each_partner = [&](std::size_t i, auto&& visit) {
    for_each_bonded(particles, i, [&](const BondNow& bond) {
      visit(bond.neighbor, bond.offset, bond.distance,
            law_->bond_force(material_, branches_.nearest.with(bond.spring, bond.entry),
                             bond.distance));
    });
    for_each_touched(particles, cells, i, [&](std::uint32_t j, const Vec3& offset, double d) {
      visit(j, offset, d, law_->force(material_, d));
    });
  };
  pair_pass(particles, material_, for_each_partner, forces);
  add_springs_of_second(particles, forces);
  if (local_.volume.empty()) return;
  find_volumes(particles);
  for_each_particle(particles.size(), [&](std::size_t i) { forces.pair[i] += volume_force(i); });
}

double Solid::energy(const Particles& particles) {
  const CellGrid cells = cells_of(particles, law_->range(material_));
  find_volumes(particles);
  return sum_over_particles(particles.size(), [&](std::size_t i) {
    double sum = 0;
    const auto add_to = [&](const Branches& branches) {
      return [&](const BondNow& bond) {  // half for each of the two
        sum += (law_->bond_energy(material_, bond.spring, bond.distance) +
                branches.energy(bond.spring, bond.entry, bond.distance)) /
               2;
      };
    };
    for_each_bonded(particles, i, add_to(branches_.nearest));
    for_each_bond(bonds_.second, particles, i, add_to(branches_.second));
    for_each_touched(particles, cells, i, [&](std::uint32_t, const Vec3&, double d) {
      sum += law_->energy(material_, d) / 2;
    });
    if (!local_.volume.empty()) sum += volume_energy(i);
    return sum;
  });
}

std::vector<double> Solid::rest_lengths() const {
  std::vector<double> lengths = bonds_.nearest.rest_length;
  const std::vector<double>& second = bonds_.second.rest_length;
  lengths.insert(lengths.end(), second.begin(), second.end());
  return lengths;
}

void Solid::restore(const std::vector<double>& rest_length) {
  const std::size_t entries = bonds_.nearest.rest_length.size() + bonds_.second.rest_length.size();
  if (rest_length.size() != entries)
    throw not_a_state("it has " + std::to_string(rest_length.size() / 2) + " bonds, not " +
                      std::to_string(entries / 2));
  if (!std::all_of(rest_length.begin(), rest_length.end(),
                   [](double length) { return length >= 0 && std::isfinite(length); }))
    throw not_a_state("a bond has no length");
  auto from = rest_length.begin();
  for (Bonds* bonds : {&bonds_.nearest, &bonds_.second}) {
    const auto end = from + static_cast<std::ptrdiff_t>(bonds->rest_length.size());
    std::copy(from, end, bonds->rest_length.begin());
    from = end;
    for (std::size_t i = 0; i < bonds->broken.size(); ++i) {
      bonds->broken[i] = 0;
      for (std::uint32_t e = bonds->neighbors.first[i]; e < bonds->neighbors.first[i + 1]; ++e)
        bonds->broken[i] += !bonds->whole(e);
    }
  }
}

/// P of each particle; none where no bond creeps.
std::vector<Mat3> Solid::flow(const Particles& particles) const {
  if (material_.bond.yield_shear <= 0) return {};
  std::vector<Mat3> flow(rest_.size(), Mat3::Zero());
  for_each_particle(rest_.size(), [&](std::size_t i) {
    double weights = 0, pulls = 0;
    Mat3 stress = Mat3::Zero(), spread = Mat3::Zero();
    const auto add = [&](const Branches& branches, const BondNow& bond) {
      const double k = bond.spring.stiffness;
      const double weight = k * (rest_[i] - rest_[bond.neighbor]).squaredNorm();
      const BondSpring now = branches.with(bond.spring, bond.entry);
      const double pull = now.stiffness * (bond.distance - now.length) * bond.distance;
      weights += weight;
      pulls += pull;
      if (bond.distance == 0) return;
      const Vec3 n = bond.offset / bond.distance;
      stress += pull * n * n.transpose();
      spread += weight * n * n.transpose();
    };
    for_each_bond(bonds_.nearest, particles, i,
                  [&](const auto& bond) { add(branches_.nearest, bond); });
    for_each_bond(bonds_.second, particles, i,
                  [&](const auto& bond) { add(branches_.second, bond); });
    if (weights == 0) return;
    const Mat3 T = (stress - pulls / weights * spread) / weights;
    const Mat3 D = strain_per_stress * (T - T.trace() / 3 * Mat3::Identity());
    const double shear = D.norm(), yield = value_at(local_.yield, i, material_.bond.yield_shear);
    if (shear > yield) flow[i] = (1 - yield / shear) * D;
  });
  return flow;
}

double Solid::breaking_strain(std::size_t i, std::size_t j) const {
  const double common = material_.bond.breaking_strain;
  return std::min(value_at(local_.breaking, i, common), value_at(local_.breaking, j, common));
}

/// Lets bonds relax, creep and break over a step (s). `repels_then`: whether a pair does so only
/// once its bond broke, or anyhow. Returns the energy lost, J.
double Solid::evolve(Bonds& bonds, Branches& branches, bool repels_then,
                     const std::vector<Mat3>& flow, const Particles& particles, double step) const {
  const BondStrength& strength = material_.bond;
  const double crept = -std::expm1(-strength.creep_rate * step);
  const auto next_length = [&](std::size_t i, const BondNow& bond) {
    const double l = bond.spring.length;
    if (strength.breaking_strain > 0 && bond.distance > l * (1 + breaking_strain(i, bond.neighbor)))
      return 0.0;
    if (flow.empty() || bond.distance == 0) return l;
    const Vec3 n = bond.offset / bond.distance;
    return l * (1 + crept * n.dot((flow[i] + flow[bond.neighbor]) * n) / 2);
  };
  // While a bond yields it grows: its pull is that of the middle of the step, not of its beginning.
  const auto growing = [&](std::size_t i, const BondNow& bond, double crept_by) {
    if (crept_by == 0) return 0.0;
    const Vec3 apart = particles.velocity(i) - particles.velocity(bond.neighbor);
    return bond.spring.stiffness * crept_by * step / 2 * apart.dot(bond.offset) / bond.distance;
  };
  const auto energy = [&](std::uint32_t e, const BondSpring& spring, double d) {
    return law_->bond_energy(material_, spring, d) + branches.energy(spring, e, d);
  };
  // Both directions of a bond see the same distance to the last bit, and change alike.
  return sum_over_particles(bonds.broken.size(), [&](std::size_t i) {
    double released = 0;
    for (std::uint32_t e = bonds.neighbors.first[i]; e < bonds.neighbors.first[i + 1]; ++e) {
      if (!bonds.whole(e)) continue;
      const std::uint32_t j = bonds.neighbors.neighbor[e];
      const Vec3 offset = particles.position(i) - particles.position(j);
      const double d = offset.norm(), before = bonds.rest_length[e], k = bonds.stiffness[e];
      released += branches.relax({before, k}, e, d) / 2;
      const double after = next_length(i, {j, offset, d, {before, k}, e});
      bonds.rest_length[e] = after;
      bonds.broken[i] += after == 0;
      const double left = after > 0     ? energy(e, {after, k}, d)
                          : repels_then ? law_->energy(material_, d)
                                        : 0;
      released += (energy(e, {before, k}, d) - left) / 2;
      if (after > 0) released += growing(i, {j, offset, d, {after, k}, e}, after - before) / 2;
    }
    return released;
  });
}

double Solid::evolve(const Particles& particles, double step) {
  if (!bonds_change(material_)) return 0;
  std::vector<bool> severed(rest_.size());
  for (std::size_t i = 0; i < severed.size(); ++i) severed[i] = broken(i) > 0;
  const std::vector<Mat3> now = flow(particles);
  double released = evolve(bonds_.nearest, branches_.nearest, true, now, particles, step) +
                    evolve(bonds_.second, branches_.second, false, now, particles, step);
  if (local_.volume.empty()) return released;
  for (std::size_t i = 0; i < severed.size(); ++i)
    if (!severed[i] && broken(i) > 0) released += volume_energy(i);
  return released;
}

BondRest::BondRest(const NeighborLists& nearest, const NeighborLists& second)
    : nearest_(nearest),
      second_(second),
      length_(nearest.neighbor.size() + second.neighbor.size(), 0) {}

void BondRest::set(std::int32_t i, std::int32_t j, bool nearest, double length) {
  const NeighborLists& lists = nearest ? nearest_ : second_;
  if (lists.size() == 0) return;
  const auto partners = lists.of(static_cast<std::size_t>(i));
  const auto at = std::lower_bound(partners.begin(), partners.end(), static_cast<std::uint32_t>(j));
  if (at == partners.end() || *at != static_cast<std::uint32_t>(j)) return;
  const std::size_t entry =
      lists.first[static_cast<std::size_t>(i)] + static_cast<std::size_t>(at - partners.begin());
  length_[(nearest ? 0 : nearest_.neighbor.size()) + entry] = length;
}

}  // namespace sinew
