// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/lists/bond_lists.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <utility>

#include <sinew/body/solid.h>
#include <sinew/core/cell_grid.h>
#include <sinew/core/parallel.h>
#include <sinew/core/particles.h>
#include <sinew/core/simulation_state.h>
#include <sinew/material/laws.h>
#include <sinew/world/world.h>

namespace sinew {
namespace {

constexpr std::size_t blocks_per_search = 512;
constexpr double same_kind = 1e-9;  // in radii: far above rounding, far below any strain

/// Kinds by their vectors, in the order in which they were met. Both directions of a bond have the
/// same length to the last bit.
class Kinds {
 public:
  explicit Kinds(double unit) : unit_(unit) {}

  std::uint32_t of(const Vec3& rest) {
    Key key{}, opposite{};
    for (int axis = 0; axis < 3; ++axis) {
      key[axis] = std::llround(rest[axis] / unit_);
      opposite[axis] = -key[axis];
    }
    const auto [at, added] = number_.try_emplace(key, static_cast<std::uint32_t>(met.size()));
    if (!added) return at->second;
    const auto known = number_.find(opposite);
    met.push_back(known == number_.end() || known == at ? rest : Vec3(-met[known->second]));
    factor.push_back(shared);
    return at->second;
  }

  /// A kind of its own.
  std::uint32_t add(const Vec3& rest, double its_factor) {
    met.push_back(rest);
    factor.push_back(its_factor);
    return static_cast<std::uint32_t>(met.size() - 1);
  }

  /// Factor of kinds of several bonds, which have their own.
  static constexpr double shared = 0;
  std::vector<Vec3> met;
  std::vector<double> factor;

 private:
  using Key = std::array<std::int64_t, 3>;

  double unit_;
  std::map<Key, std::uint32_t> number_;
};

double factor_of(const BondFactors::Row& row, std::uint32_t id) {
  return row.empty() ? 1 : row.at(id);
}

/// The neighbors at rest of a body's particles, by place in the kernel's order.
struct RestNeighbors {
  Points rest;           ///< in the kernel's order
  bool kinds;            ///< whether they differ
  double r;              ///< m
  double nearest_range;  ///< m
  double range;          ///< range of neighbors that count, m
  std::span<const std::int32_t> id;
  const BondFactors& factors;
  CellGrid grid;

  RestNeighbors(const Body& body, std::span<const std::int32_t> ids)
      : rest(in_order(body.rest, ids)),
        kinds(law_of(body.material).has_bonds || has_muscles(body)),
        r(body.material.pair.r),
        nearest_range(rest_neighbor_range(r)),
        range(body.material.bond.second > 0 ? second_neighbor_range * r : nearest_range),
        id(ids),
        factors(body.factors),
        grid(rest, range) {}

  static Points in_order(const Points& rest, std::span<const std::int32_t> ids) {
    Points ordered;
    ordered.reserve(ids.size());
    for (const std::int32_t i : ids) ordered.push_back(rest[static_cast<std::size_t>(i)]);
    return ordered;
  }

  bool is_nearest(const Vec3& X) const { return X.norm() < nearest_range; }
  /// Whether it has a length of a lattice, as many others do.
  bool is_usual(const Vec3& X) const {
    constexpr double about = 1e-6;  // radii
    const double d = X.norm();
    return std::abs(d - nearest_distance(r)) < about * r ||
           std::abs(d - second_distance(r)) < about * r;
  }
  double factor(const BondFactors::Row& row, std::uint32_t j) const {
    return factor_of(row, static_cast<std::uint32_t>(id[j]));
  }
};

/// The entries of some blocks, with kinds of their own.
struct Piece {
  std::vector<std::uint32_t> nearest, count;  ///< entries by block: of nearest neighbors, and all
  std::vector<kernel::BondEntry> entries;
  std::vector<Vec3> kinds;
  std::vector<double> kind_factor;
  std::int32_t rows = 0;  ///< entries with a stiffness by lane
};

/// A bond of one particle.
struct Found {
  kernel::BondEntry entry;
  double factor;
};

bool ascending(const kernel::BondEntry& a, const kernel::BondEntry& b) {
  return a.difference != b.difference ? a.difference < b.difference : a.kind < b.kind;
}

/// Appends entries with the lanes of all that are equal.
void merge(std::vector<Found>& found, Piece& piece) {
  std::sort(found.begin(), found.end(),
            [](const Found& a, const Found& b) { return ascending(a.entry, b.entry); });
  const std::size_t before = piece.entries.size();
  for (const Found& one : found) {
    if (piece.entries.size() > before && !ascending(piece.entries.back(), one.entry))
      piece.entries.back().lanes |= one.entry.lanes;
    else
      piece.entries.push_back(one.entry);
    if (one.factor != 1 && piece.entries.back().own < 0) piece.entries.back().own = piece.rows++;
  }
}

Piece entries_of(const RestNeighbors& of, std::size_t block_size, double unit, std::size_t begin,
                 std::size_t end) {
  Piece piece;
  Kinds kinds(unit);
  std::vector<Found> nearest, second;
  std::vector<std::uint32_t> near;
  for (std::size_t block = begin; block < end; ++block) {
    nearest.clear(), second.clear();
    for (std::size_t lane = 0; lane < block_size; ++lane) {
      const std::size_t k = block * block_size + lane;
      if (k >= of.rest.size()) break;
      const BondFactors::Row row = of.factors.of(static_cast<std::uint32_t>(of.id[k]));
      near.clear();
      append_neighbors(of.grid, of.rest, k, of.range, near);
      for (const std::uint32_t j : near) {
        const auto difference =
            static_cast<std::int32_t>(static_cast<std::int64_t>(j) - static_cast<std::int64_t>(k));
        const Vec3 X = of.rest[j] - of.rest[k];
        const bool alone = of.kinds && !of.is_usual(X);
        const double factor = of.factor(row, j);
        const std::uint32_t kind =
            alone ? kinds.add(X, factor) : kinds.of(of.kinds ? X : Vec3::Zero());
        const std::uint32_t own = std::uint32_t{1} << lane;
        (of.is_nearest(X) ? nearest : second)
            .push_back(
                {{difference, kind, own | own << kernel::rest_lanes, -1}, alone ? 1 : factor});
      }
    }
    const std::size_t before = piece.entries.size();
    merge(nearest, piece);
    piece.nearest.push_back(static_cast<std::uint32_t>(piece.entries.size() - before));
    merge(second, piece);
    piece.count.push_back(static_cast<std::uint32_t>(piece.entries.size() - before));
  }
  piece.entries.shrink_to_fit();
  piece.kinds = std::move(kinds.met);
  piece.kind_factor = std::move(kinds.factor);
  return piece;
}

/// Finds the entries of all blocks. What that takes is freed before they are joined.
std::vector<Piece> all_entries(const Body& body, std::span<const std::int32_t> id,
                               std::size_t block_size, double unit) {
  const RestNeighbors of(body, id);
  const std::size_t blocks = (id.size() + block_size - 1) / block_size;
  std::vector<Piece> pieces((blocks + blocks_per_search - 1) / blocks_per_search);
  parallel_for(blocks, blocks_per_search, [&](std::size_t begin, std::size_t end) {
    pieces[begin / blocks_per_search] = entries_of(of, block_size, unit, begin, end);
  });
  return pieces;
}

/// Joins the pieces in their order; equal kinds become one.
template <class Real>
void join(std::vector<Piece> pieces, double unit, BondLists<Real>& bonds) {
  Kinds kinds(unit);
  std::size_t entries = 0;
  std::int32_t rows = 0;
  for (const Piece& piece : pieces) entries += piece.entries.size();
  bonds.entries.reserve(entries);
  bonds.first.push_back(0);
  for (Piece& piece : pieces) {
    std::vector<std::uint32_t> number;
    for (std::size_t k = 0; k < piece.kinds.size(); ++k)
      number.push_back(piece.kind_factor[k] == Kinds::shared
                           ? kinds.of(piece.kinds[k])
                           : kinds.add(piece.kinds[k], piece.kind_factor[k]));
    for (kernel::BondEntry entry : piece.entries) {
      entry.kind = number[entry.kind];
      if (entry.own >= 0) entry.own += rows;
      bonds.entries.push_back(entry);
    }
    rows += piece.rows;
    for (std::size_t k = 0; k < piece.count.size(); ++k) {
      bonds.second.push_back(bonds.first.back() + piece.nearest[k]);
      bonds.first.push_back(bonds.first.back() + piece.count[k]);
    }
    piece = {};
  }
  bonds.own.resize(static_cast<std::size_t>(rows) * kernel::Traits<Real>::block);
  bonds.rest = std::move(kinds.met);
  bonds.kind_factor = std::move(kinds.factor);
}

}  // namespace

template <class Real>
void BondLists<Real>::set_units(const Body& body, std::span<const std::int32_t> id, double mass,
                                const Units& units) {
  const auto stiffness_of = [&](const Vec3& to) {
    const BondStrength& strength = body.material.bond;
    const bool nearest = to.norm() < rest_neighbor_range(body.material.pair.r);
    return (nearest ? strength.stiffness : strength.second) * units.time * units.time / mass;
  };
  const double longer =
      kinds.empty() ? 1 : rest[0].norm() / units.length / static_cast<double>(kinds[0].length);
  if (!kinds.empty() && kinds[0].length > 0)
    for (Real& one : creep) one = static_cast<Real>(static_cast<double>(one) * longer);
  if (longer != 1) branches.scale(longer);
  kinds.clear();
  for (std::size_t k = 0; k < rest.size(); ++k) {
    const Vec3& to = rest[k];
    const double of_kind = kind_factor[k] == Kinds::shared ? 1 : kind_factor[k];
    kernel::BondKind<Real> kind{};
    for (int axis = 0; axis < 3; ++axis)
      kind.rest[axis] = static_cast<Real>(to[axis] / units.length);
    kind.length = static_cast<Real>(to.norm() / units.length);
    kind.stiffness = static_cast<Real>(of_kind * stiffness_of(to));
    kinds.push_back(kind);
  }
  set_own(body.factors, id, stiffness_of);
}

/// Sets the stiffness by lane of the bonds of entries that have one.
template <class Real>
template <class StiffnessOf>
void BondLists<Real>::set_own(const BondFactors& factors, std::span<const std::int32_t> id,
                              const StiffnessOf& stiffness_of) {
  constexpr std::size_t size = kernel::Traits<Real>::block;
  if (own.empty()) return;
  const auto of_block = [&](std::size_t block, std::size_t lane) {
    const std::size_t k = block * size + lane;
    if (k >= id.size()) return;
    const BondFactors::Row row = factors.of(static_cast<std::uint32_t>(id[k]));
    for (std::uint32_t e = first[block]; e < first[block + 1]; ++e) {
      const kernel::BondEntry& entry = entries[e];
      if (entry.own < 0 || (entry.lanes >> (kernel::rest_lanes + lane) & 1) == 0) continue;
      const auto j = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(k) + entry.difference);
      own[static_cast<std::size_t>(entry.own) * size + lane] = static_cast<Real>(
          factor_of(row, static_cast<std::uint32_t>(id[j])) * stiffness_of(rest[entry.kind]));
    }
  };
  parallel_for(first.size() - 1, blocks_per_search, [&](std::size_t begin, std::size_t end) {
    for (std::size_t block = begin; block < end; ++block)
      for (std::size_t lane = 0; lane < size; ++lane) of_block(block, lane);
  });
}

template <class Real>
kernel::Bonds<Real> BondLists<Real>::arrays(const Material& material, double step) {
  const BondStrength& strength = material.bond;
  const auto real = [](double value) { return static_cast<Real>(value); };
  constexpr std::size_t block = kernel::Traits<Real>::block;
  kernel::Bonds<Real> bonds{};
  bonds.first = first.data();
  bonds.second = second.data();
  bonds.entries = entries.data();
  bonds.kinds = kinds.data();
  bonds.own = own.data();
  bonds.broken = broken.empty() ? nullptr : broken.data();
  bonds.breaking = real(strength.breaking_strain);
  branches.put_into(bonds, step);
  if (!breaking.empty()) bonds.breaking_of = breaking.data() + block;
  if (creep.empty()) return bonds;
  bonds.creep = creep.data();
  for (std::size_t k = 0; k < flow.size(); ++k) bonds.flow[k] = flow[k].data() + block;
  bonds.flows = flows.data() + block;
  bonds.look = look.data();
  bonds.yield = real(strength.yield_shear * strength.yield_shear);
  if (!yield.empty()) bonds.yield_of = yield.data() + block;
  bonds.crept = real(-std::expm1(-strength.creep_rate * step));
  return bonds;
}

template <class Real>
std::uint32_t BondLists<Real>::bonded_lanes(std::size_t block, std::int32_t difference) const {
  const auto end = entries.begin() + second[block];
  std::uint32_t lanes = 0;
  for (auto at = std::lower_bound(entries.begin() + first[block], end, difference,
                                  [](const kernel::BondEntry&entry, std::int32_t wanted) {
                                    return entry.difference < wanted;
                                  });
       at != end && at->difference == difference; ++at)
    lanes |= at->lanes;
  return lanes & ((std::uint32_t{1} << kernel::rest_lanes) - 1);
}

template <class Real>
BondLists<Real> bond_lists(const Body& body, double mass, std::span<const std::int32_t> id,
                           const Units& units) {
  constexpr std::size_t size = kernel::Traits<Real>::block;
  BondLists<Real> bonds;
  if (!law_of(body.material).has_memory && !has_muscles(body)) return bonds;
  const double unit = same_kind * body.material.pair.r;
  const std::size_t blocks = (id.size() + size - 1) / size;
  join(all_entries(body, id, size, unit), unit, bonds);
  bonds.set_units(body, id, mass, units);
  if (!law_of(body.material).has_bonds) return bonds;
  const BondStrength& strength = body.material.bond;
  if (strength.yield_shear > 0) {
    bonds.creep.assign(bonds.entries.size() * size, 0);
    for (auto& values : bonds.flow) values.assign((blocks + 2) * size, 0);
    bonds.flows.assign((blocks + 2) * size, 0);
    bonds.look.resize((blocks + kernel::blocks_per_piece - 1) / kernel::blocks_per_piece);
  }
  if (strength.breaking_strain > 0) bonds.broken.assign(blocks * size, 0);
  bonds.branches = BondBranches<Real>(strength, bonds.entries.size());
  const auto by_particle = [&](const std::vector<double>& local, const auto& value) {
    Lines<Real> values(local.empty() ? 0 : (blocks + 2) * size, 1);
    for (std::size_t k = 0; k < id.size() && !local.empty(); ++k)
      values[size + k] = static_cast<Real>(value(local[static_cast<std::size_t>(id[k])]));
    return values;
  };
  bonds.yield = by_particle(body.local.yield, [](double shear) { return shear * shear; });
  bonds.breaking = by_particle(body.local.breaking, [](double strain) { return 1 + strain; });
  return bonds;
}

// What is read of bonds, saved and restored.

template <class Real>
void BondLists<Real>::read(std::span<const std::int32_t> id, const Units& units,
                           BondRest& found) const {
  constexpr std::size_t size = kernel::Traits<Real>::block;
  for (std::size_t block = 0; block + 1 < first.size(); ++block)
    for (std::uint32_t e = first[block]; e < first[block + 1]; ++e)
      for (std::size_t lane = 0; lane < size; ++lane) {
        const kernel::BondEntry& entry = entries[e];
        if ((entry.lanes >> lane & 1) == 0) continue;
        const std::size_t k = block * size + lane;
        const double crept = (creep.empty() ? 0 : static_cast<double>(creep[e * size + lane])) +
                             branches.shift(e * size + lane);
        found.set(id[k], id[k + static_cast<std::size_t>(entry.difference)], e < second[block],
                  (static_cast<double>(kinds[entry.kind].length) + crept) * units.length);
      }
}

template <class Real>
void BondLists<Real>::save(SimulationState& state) const {
  if (!change()) return;
  std::vector<std::uint32_t> lanes;  // one per entry
  std::vector<double> crept;         // each whole bond, in lengths of the kernel
  for (const kernel::BondEntry& entry : entries) lanes.push_back(entry.lanes);
  const auto add = [&](std::size_t at) { crept.push_back(static_cast<double>(creep[at])); };
  if (!creep.empty()) for_each_whole<kernel::Traits<Real>::block>(entries, add);
  put_column(state, "bonds", "lanes", std::move(lanes));
  put_column(state, "bonds", "creep", std::move(crept));
  branches.save(entries, state);
}

template <class Real>
void BondLists<Real>::restore(const SimulationState& state) {
  constexpr std::size_t size = kernel::Traits<Real>::block;
  if (!change()) return;
  const auto lanes = column_of<std::uint32_t>(state, "bonds", "lanes");
  const auto crept = column_of<double>(state, "bonds", "creep");
  if (lanes.size() != entries.size()) throw not_a_state("it has other bonds");
  for (std::size_t block = 0; block + 1 < first.size(); ++block)
    for (std::uint32_t e = first[block]; e < first[block + 1]; ++e) {
      const std::uint32_t made = std::exchange(entries[e].lanes, lanes[e]);
      if ((entries[e].lanes & ~made) != 0 || (made & ~entries[e].lanes) >> kernel::rest_lanes != 0)
        throw not_a_state("it has other bonds");
      for (std::size_t lane = 0; lane < size && !broken.empty(); ++lane)
        broken[block * size + lane] +=
            static_cast<std::int32_t>((made & ~entries[e].lanes) >> lane & 1);
    }
  std::size_t next = 0;
  const auto take = [&](std::size_t at) {
    if (next == crept.size() || !std::isfinite(crept[next]))
      throw not_a_state("a bond has no length");
    creep[at] = static_cast<Real>(crept[next++]);
  };
  if (!creep.empty()) for_each_whole<size>(entries, take);
  if (next != crept.size()) throw not_a_state("it has other bonds");
  branches.restore(entries, state);
}

template struct BondLists<double>;
template struct BondLists<float>;
template BondLists<double> bond_lists(const Body&, double, std::span<const std::int32_t>,
                                      const Units&);
template BondLists<float> bond_lists(const Body&, double, std::span<const std::int32_t>,
                                     const Units&);

}  // namespace sinew
