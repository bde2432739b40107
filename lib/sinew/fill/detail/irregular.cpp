// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/fill/detail/irregular.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/error.h>
#include <sinew/core/particles.h>
#include <sinew/core/union_find.h>
#include <sinew/fill/detail/conformal.h>
#include <sinew/fill/detail/random.h>

namespace sinew {
namespace {

void find_groups(Irregular& packed) {
  UnionFind sets(packed.places.size());
  for (std::size_t i = 0; i < packed.places.size(); ++i)
    for (const std::uint32_t j : packed.touching.of(i))
      sets.join(static_cast<int>(i), static_cast<int>(j));
  packed.group.resize(packed.places.size());
  for (std::size_t i = 0; i < packed.group.size(); ++i) {
    const auto first = static_cast<std::size_t>(sets.first_of(static_cast<int>(i)));
    packed.group[i] = first == i ? packed.groups++ : packed.group[first];
  }
}

void find_distances(Irregular& packed) {
  double smallest = HUGE_VAL, sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < packed.places.size(); ++i) {
    for (const std::uint32_t j : packed.touching.of(i)) {
      const Vec3 bond = packed.places[i] - packed.places[j];
      const double d = bond.norm();
      packed.springs.add(bond);
      smallest = std::min(smallest, d);
      sum += d;
      ++count;
    }
  }
  if (count == 0) return;
  packed.smallest = smallest;
  packed.mean = sum / static_cast<double>(count);
}

}  // namespace

Irregular irregular_packing(const BodySpace& space, const PackOptions& options,
                            const FilledSites& filled) {
  Irregular packed = options.packing == Packing::random ? random_packing(space, options, filled)
                                                        : conformal_packing(space, options, filled);
  if (packed.places.empty())
    throw bad_input("no particle of the packing lies inside", "give a smaller radius");
  packed.touching = neighbors_within(packed.places, rest_neighbor_range(filled.lattice.radius));
  find_groups(packed);
  find_distances(packed);
  return packed;
}

}  // namespace sinew
