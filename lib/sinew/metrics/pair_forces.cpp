// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/pair_forces.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/deformation.h>
#include <sinew/core/parallel.h>
#include <sinew/core/particles.h>

namespace sinew {

namespace {

constexpr std::size_t particles_per_task = 1024;

/// A bond seen from one of its particles.
struct BondState {
  std::uint32_t neighbor;
  Vec3 apart;     ///< from it, m
  double length;  ///< m
  double rest;    ///< its rest length, m
  bool whole;
  double force;  ///< N, positive repels; 0 once broken
};

double force_of(const ForcesOfPairs& law, bool nearest, double d, double rest) {
  if (!nearest) return law.second(d, rest);
  if (law.bond) return law.bond(d, rest);
  return law.force ? law.force(d) : not_measured;
}

/// Calls visit(BondState) for the bonds of particle i: to nearest neighbors, then to second ones.
template <class Visit>
void for_each_bond(const RestBody& rest, const FrameState& state, std::size_t i,
                   const Visit& visit) {
  const Points& now = state.positions;
  const BondStiffness& stiffness = rest.stiffness();
  const std::vector<double>& lengths = state.bond_rest.empty() ? stiffness.length : state.bond_rest;
  const auto among = [&](const NeighborLists& lists, std::size_t before, bool nearest) {
    if (lists.size() == 0) return;
    for (std::uint32_t e = lists.first[i]; e < lists.first[i + 1]; ++e) {
      const std::uint32_t j = lists.neighbor[e];
      BondState bond{j, now[i] - now[j], 0, 0, true, 0};
      bond.length = bond.apart.norm();
      bond.rest = lengths.empty() ? (rest.shape.points[i] - rest.shape.points[j]).norm()
                                  : lengths[before + e];
      bond.whole = bond.rest > 0 && bond.length < rest.law.reach;
      if (bond.whole)
        bond.force = (stiffness.factor.empty() ? 1 : stiffness.factor[before + e]) *
                     force_of(rest.law, nearest, bond.length, bond.rest);
      visit(bond);
    }
  };
  among(rest.shape.neighbors, 0, true);
  among(rest.second, rest.shape.neighbors.neighbor.size(), false);
}

/// -f (x) r of one pair, N m.
Mat3 virial(double force, const Vec3& apart, double d) {
  return -force / d * apart * apart.transpose();
}

/// Returns the stress of a particle's volume energy U = (K_v / 2) V0 w (J - 1)^2, over V0. It is
/// severed and keeps no volume once a bond broke.
Mat3 volume_stress(const RestBody& rest, const FrameState& state, std::size_t i, bool severed) {
  const std::vector<double>& weight = rest.stiffness().volume_weight;
  if (weight.empty() || weight[i] == 0 || severed) return Mat3::Zero();
  const double J = deformation_gradient(rest.shape, state.positions, i).determinant();
  const auto& local = rest.law.volume_stiffness_of;
  const double stiffness = local.empty() ? rest.law.volume_stiffness : local[i];
  return stiffness * weight[i] * (J - 1) * J * Mat3::Identity();
}

}  // namespace

std::span<const Neighbor> find_neighbors(const Points& now, const CellGrid& grid, double range,
                                         std::size_t i, std::vector<Neighbor>& found) {
  std::size_t count = 0;
  grid.for_each_near(now[i], [&](std::uint32_t j) {
    if (count == found.size()) found.resize(2 * count + 64);
    const double squared = (now[i] - now[j]).squaredNorm();
    found[count] = {j, squared};  // without a branch, which would be guessed wrong often
    count += static_cast<std::size_t>(squared < range * range) & static_cast<std::size_t>(j != i);
  });
  return {found.data(), count};
}

bool knows_forces(const RestBody& rest, const FrameState& state) {
  const ForcesOfPairs& law = rest.law;
  return law.force && !(law.bonds_change && state.bond_rest.empty()) &&
         !(law.has_muscles && state.muscle_stress.empty());
}

Mat3 kirchhoff_stress(const RestBody& rest, const FrameState& state,
                      std::span<const Neighbor> neighbors, std::size_t i) {
  const double range = rest.interaction_range;
  const bool has_bonds = static_cast<bool>(rest.law.bond);
  const auto nearest = rest.shape.neighbors.of(i);
  const std::uint32_t first = rest.shape.neighbors.first[i];
  const auto bonded = [&](std::uint32_t j) {
    const auto at = std::lower_bound(nearest.begin(), nearest.end(), j);
    if (at == nearest.end() || *at != j) return false;
    return state.bond_rest.empty() ||
           state.bond_rest[first + static_cast<std::size_t>(at - nearest.begin())] > 0;
  };
  Mat3 sum = Mat3::Zero();
  bool severed = false;
  if (has_bonds)
    for_each_bond(rest, state, i, [&](const BondState& bond) {
      severed = severed || !(bond.rest > 0);
      if (bond.whole && bond.length > 0) sum += virial(bond.force, bond.apart, bond.length);
    });
  for (const Neighbor& other : neighbors) {
    if (other.squared >= range * range || other.squared == 0) continue;
    if (has_bonds && bonded(other.index)) continue;
    const double d = std::sqrt(other.squared);
    sum += virial(rest.law.force(d), state.positions[i] - state.positions[other.index], d);
  }
  const std::vector<double>& shares = rest.stiffness().volume_share;
  const double volume_share = shares.empty() ? 1 : shares[i];
  if (!(volume_share > 0)) return Mat3::Constant(not_measured);
  const Mat3 passive = sum / (2 * volume_per_particle(rest.radius));
  const Mat3 stress = (passive + volume_stress(rest, state, i, severed)) / volume_share;
  return state.muscle_stress.empty() ? stress : Mat3(stress + state.muscle_stress[i]);
}

std::vector<Mat3> kirchhoff_stresses(const RestBody& rest, const FrameState& state) {
  std::vector<Mat3> found(state.positions.size(), Mat3::Constant(not_measured));
  if (!knows_forces(rest, state)) return found;
  const CellGrid grid(state.positions, rest.interaction_range);
  parallel_for(found.size(), particles_per_task, [&](std::size_t begin, std::size_t end) {
    std::vector<Neighbor> neighbors;
    for (std::size_t i = begin; i < end; ++i) {
      const auto near = find_neighbors(state.positions, grid, rest.interaction_range, i, neighbors);
      found[i] = kirchhoff_stress(rest, state, near, i);
    }
  });
  return found;
}

Mat3 cauchy_stress(const Mat3& kirchhoff, double J) {
  return J > min_volume_ratio ? Mat3(kirchhoff / J) : Mat3::Constant(not_measured);
}

double von_mises(const Mat3& stress) {
  const Mat3 deviator = stress - stress.trace() / 3 * Mat3::Identity();
  return std::sqrt(1.5 * deviator.squaredNorm());
}

BondValues bond_values(const RestBody& rest, const FrameState& state) {
  BondValues values;
  const bool known = rest.law.force && !(rest.law.bonds_change && state.bond_rest.empty());
  for (std::uint32_t i = 0; i < rest.particles(); ++i)
    for_each_bond(rest, state, i, [&](const BondState& bond) {
      if (bond.neighbor < i) return;
      values.ends.push_back({i, bond.neighbor});
      values.length.push_back(bond.length);
      values.strain.push_back(bond.whole ? bond.length / bond.rest - 1 : not_measured);
      values.force.push_back(known ? -bond.force : not_measured);
      values.broken.push_back(!bond.whole);
    });
  return values;
}

}  // namespace sinew
