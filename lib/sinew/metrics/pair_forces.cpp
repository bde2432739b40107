// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/pair_forces.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <sinew/body/body.h>
#include <sinew/core/deformation.h>
#include <sinew/core/parallel.h>
#include <sinew/core/particles.h>
#include <sinew/material/laws.h>

namespace sinew {

namespace {

constexpr std::size_t particles_per_task = 1024;

/// A bond seen from one of its particles.
struct BondState {
  std::uint32_t neighbor;
  Vec3 apart;     ///< vector from it, m
  double length;  ///< m
  double rest;    ///< its rest length, m
  bool whole, nearest;
  double factor;  ///< on its stiffness
  double force;   ///< N, positive repels; 0 once broken
};

/// The forces between a body's particles.
class PairForces {
 public:
  explicit PairForces(const RestBody& rest)
      : law_(law_of(rest.material)),
        material_(rest.material),
        second_(law_.has_memory ? rest.material.bond.second : 0) {}

  /// Whether neighbors at rest act otherwise than others do.
  bool has_bonds() const { return law_.has_memory; }
  /// Neighbors at rest farther apart than this hold no longer, m.
  double reach() const {
    return law_.has_bonds ? std::numeric_limits<double>::infinity() : material_.pair.b;
  }
  double force(double d) const { return law_.force(material_, d); }
  double energy(double d) const { return law_.energy(material_, d); }
  double bond_force(bool nearest, double d, double rest) const {
    return law_.has_memory ? law_.bond_force(material_, spring(nearest, rest), d) : force(d);
  }
  double bond_energy(bool nearest, double d, double rest) const {
    return law_.bond_energy(material_, spring(nearest, rest), d);
  }
  double volume_stiffness() const { return law_.has_bonds ? material_.volume_stiffness : 0; }

 private:
  BondSpring spring(bool nearest, double rest) const {
    return {rest, nearest ? material_.bond.stiffness : second_};
  }

  const ForceLaw& law_;
  const Material& material_;
  double second_;
};

/// Calls visit(BondState) for the bonds of particle i: to nearest neighbors, then to second ones.
template <class Visit>
void for_each_bond(const RestBody& rest, const FrameState& state, std::size_t i,
                   const Visit& visit) {
  const Points& now = state.positions;
  const BondStiffness& stiffness = rest.stiffness();
  const PairForces pair(rest);
  const std::vector<double>& lengths = state.bond_rest.empty() ? stiffness.length : state.bond_rest;
  const auto among = [&](const NeighborLists& lists, std::size_t before, bool nearest) {
    if (lists.size() == 0) return;
    for (std::uint32_t e = lists.first[i]; e < lists.first[i + 1]; ++e) {
      const std::uint32_t j = lists.neighbor[e];
      BondState bond{j, now[i] - now[j], 0, 0, true, nearest, 1, 0};
      if (!stiffness.factor.empty()) bond.factor = stiffness.factor[before + e];
      bond.length = bond.apart.norm();
      bond.rest = lengths.empty() ? (rest.shape.points[i] - rest.shape.points[j]).norm()
                                  : lengths[before + e];
      bond.whole = bond.rest > 0 && bond.length < pair.reach();
      if (bond.whole) bond.force = bond.factor * pair.bond_force(nearest, bond.length, bond.rest);
      visit(bond);
    }
  };
  among(rest.shape.neighbors, 0, true);
  among(rest.second, rest.shape.neighbors.neighbor.size(), false);
}

/// Whether the body's law and the state determine the forces of bonds.
bool knows_bonds(const RestBody& rest, const FrameState& state) {
  return rest.forces.known && !(bonds_change(rest.material) && state.bond_rest.empty());
}

/// -f (x) r of one pair, N m.
Mat3 virial(double force, const Vec3& apart, double d) {
  return -force / d * apart * apart.transpose();
}

/// Stiffness K_v w (Pa) and J of the energy of a particle's volume, U = (K_v / 2) V0 w (J - 1)^2.
/// It is severed and keeps no volume once a bond broke.
struct KeptVolume {
  double stiffness = 0, J = 1;

  Mat3 stress() const { return stiffness * (J - 1) * J * Mat3::Identity(); }
  double energy_density() const { return stiffness / 2 * (J - 1) * (J - 1); }
};

KeptVolume kept_volume(const RestBody& rest, const FrameState& state, std::size_t i, bool severed) {
  const std::vector<double>& weight = rest.stiffness().volume_weight;
  if (weight.empty() || weight[i] == 0 || severed) return {};
  const auto& local = rest.forces.volume_stiffness;
  return {(local.empty() ? PairForces(rest).volume_stiffness() : local[i]) * weight[i],
          deformation_gradient(rest.shape, state.positions, i).determinant()};
}

/// Calls on_bond(BondState) for the bonds of particle i that hold, and on_other(Neighbor) for all
/// others within b. Returns whether a bond of it broke.
template <class OnBond, class OnOther>
bool for_each_pair(const RestBody& rest, const FrameState& state,
                   std::span<const Neighbor> neighbors, std::size_t i, const OnBond& on_bond,
                   const OnOther& on_other) {
  const double range = rest.interaction_range();
  const bool has_bonds = PairForces(rest).has_bonds();
  const auto nearest = rest.shape.neighbors.of(i);
  const std::uint32_t first = rest.shape.neighbors.first[i];
  const auto bonded = [&](std::uint32_t j) {
    const auto at = std::lower_bound(nearest.begin(), nearest.end(), j);
    if (at == nearest.end() || *at != j) return false;
    return state.bond_rest.empty() ||
           state.bond_rest[first + static_cast<std::size_t>(at - nearest.begin())] > 0;
  };
  const double near = rest.forces.pass.any() ? near_at_rest(rest.material) : 0;
  const auto passes = [&](std::uint32_t j) {
    return rest.forces.pass.between(rest.bone_of[i], rest.bone_of[j]) &&
           (rest.shape.points[i] - rest.shape.points[j]).norm() >= near;
  };
  bool severed = false;
  if (has_bonds)
    for_each_bond(rest, state, i, [&](const BondState& bond) {
      severed = severed || !(bond.rest > 0);
      if (bond.whole && bond.length > 0) on_bond(bond);
    });
  for (const Neighbor& other : neighbors)
    if (other.squared < range * range && other.squared > 0 && !(has_bonds && bonded(other.index)) &&
        !passes(other.index))
      on_other(other);
  return severed;
}

/// Volume of a particle over that of one inside.
double volume_share(const RestBody& rest, std::size_t i) {
  const std::vector<double>& shares = rest.stiffness().volume_share;
  return shares.empty() ? 1 : shares[i];
}

/// Calls found(i, its neighbors within b) for each particle. In parallel.
template <class Found>
void for_each_surrounded(const RestBody& rest, const FrameState& state, const Found& found) {
  const CellGrid grid(state.positions, rest.interaction_range());
  parallel_for(rest.particles(), particles_per_task, [&](std::size_t begin, std::size_t end) {
    std::vector<Neighbor> neighbors;
    for (std::size_t i = begin; i < end; ++i) {
      found(i, find_neighbors(state.positions, grid, rest.interaction_range(), i, neighbors));
    }
  });
}

double energy_density(const RestBody& rest, const FrameState& state,
                      std::span<const Neighbor> neighbors, std::size_t i) {
  const PairForces pair(rest);
  double sum = 0;
  const bool severed = for_each_pair(
      rest, state, neighbors, i,
      [&](const BondState& bond) {
        sum += bond.factor * pair.bond_energy(bond.nearest, bond.length, bond.rest) / 2;
      },
      [&](const Neighbor& other) { sum += pair.energy(std::sqrt(other.squared)) / 2; });
  const double of_volume = kept_volume(rest, state, i, severed).energy_density();
  const double share = volume_share(rest, i);
  return share > 0 ? (sum / volume_per_particle(rest.radius()) + of_volume) / share : not_measured;
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
  return knows_bonds(rest, state) && !(rest.forces.has_muscles && state.muscle_stress.empty());
}

Mat3 kirchhoff_stress(const RestBody& rest, const FrameState& state,
                      std::span<const Neighbor> neighbors, std::size_t i) {
  const PairForces pair(rest);
  Mat3 sum = Mat3::Zero();
  const bool severed = for_each_pair(
      rest, state, neighbors, i,
      [&](const BondState& bond) { sum += virial(bond.force, bond.apart, bond.length); },
      [&](const Neighbor& other) {
        const double d = std::sqrt(other.squared);
        sum += virial(pair.force(d), state.positions[i] - state.positions[other.index], d);
      });
  const double share = volume_share(rest, i);
  if (!(share > 0)) return Mat3::Constant(not_measured);
  const Mat3 passive = sum / (2 * volume_per_particle(rest.radius()));
  const Mat3 stress = (passive + kept_volume(rest, state, i, severed).stress()) / share;
  return state.muscle_stress.empty() ? stress : Mat3(stress + state.muscle_stress[i]);
}

std::vector<Mat3> kirchhoff_stresses(const RestBody& rest, const FrameState& state) {
  std::vector<Mat3> found(state.positions.size(), Mat3::Constant(not_measured));
  if (!knows_forces(rest, state)) return found;
  for_each_surrounded(rest, state, [&](std::size_t i, std::span<const Neighbor> neighbors) {
    found[i] = kirchhoff_stress(rest, state, neighbors, i);
  });
  return found;
}

std::vector<double> energy_densities(const RestBody& rest, const FrameState& state) {
  std::vector<double> found(state.positions.size(), not_measured);
  if (!knows_forces(rest, state) || rest.material.bond.branch_count() > 0) return found;
  for_each_surrounded(rest, state, [&](std::size_t i, std::span<const Neighbor> neighbors) {
    found[i] = energy_density(rest, state, neighbors, i);
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
  const bool known = knows_bonds(rest, state);
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
