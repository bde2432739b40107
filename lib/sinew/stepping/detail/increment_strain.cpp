// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/stepping/detail/increment_strain.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <sinew/core/parallel.h>
#include <sinew/material/laws.h>

namespace sinew {
namespace {

constexpr std::size_t particles_per_task = 1024;
constexpr double parted = 1.5;  // times the greatest distance of neighbors at rest
constexpr double of_pairs = 0.99;

bool is_elastic(const Material& material) {
  return law_of(material).has_bonds && !bonds_change(material);
}

}  // namespace

StrainMeter::StrainMeter(const Body& body, const RestNeighbors& near)
    : shape_(rest_shape(body.rest, near.nearest)),
      all_count_(is_elastic(body.material)),
      range_(parted * rest_neighbor_range(body.material.pair.r)) {}

void StrainMeter::begin(Points positions) {
  begin_ = std::move(positions);
  inverted_ = inverted_in(begin_);
}

std::size_t StrainMeter::inverted_in(const Points& positions) const {
  return static_cast<std::size_t>(
      parallel_sum(positions.size(), particles_per_task, [&](std::size_t first, std::size_t last) {
        double count = 0;
        for (std::size_t i = first; i < last; ++i)
          if (shape_.defined(i) && deformation_gradient(shape_, positions, i).determinant() <= 0)
            ++count;
        return count;
      }));
}

IncrementStrain StrainMeter::since(const Points& positions) const {
  const NeighborLists& near = shape_.neighbors;
  std::vector<double> changes(near.neighbor.size(), 0.0);
  parallel_for(positions.size(), particles_per_task, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i)
      for (std::uint32_t k = near.first[i]; k < near.first[i + 1]; ++k) {
        const std::uint32_t j = near.neighbor[k];
        const double before = (begin_[j] - begin_[i]).norm(),
                     after = (positions[j] - positions[i]).norm();
        if (before > 0 && std::max(before, after) < range_)
          changes[k] = std::abs(after / before - 1);
      }
  });
  IncrementStrain found;
  found.inverted = inverted_in(positions);
  if (changes.empty()) return found;
  const auto last = static_cast<double>(changes.size() - 1);
  const auto place =
      changes.begin() + static_cast<std::ptrdiff_t>(all_count_ ? last : of_pairs * last);
  std::nth_element(changes.begin(), place, changes.end());
  found.strain = *place;
  return found;
}

}  // namespace sinew
