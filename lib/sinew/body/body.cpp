// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/body/body.h>

#include <algorithm>

#include <sinew/material/laws.h>

namespace sinew {

double near_at_rest(const Material& material) {
  return std::max(rest_neighbor_range(material.pair.r), law_of(material).range(material));
}

bool pass_through(const Body& body, std::size_t a, std::size_t b) {
  const double near = near_at_rest(body.material);
  return body.pass_through.any() &&
         body.pass_through.between(body.binding.bone(a), body.binding.bone(b)) &&
         (body.rest[a] - body.rest[b]).squaredNorm() >= near * near;
}

SharedNeighbors neighbors_of(const Body& body) {
  if (body.neighbors) return body.neighbors;
  const Material& material = body.material;
  return std::make_shared<const RestNeighbors>(
      rest_neighbors(body.rest, material.pair.r, material.bond.second > 0));
}

double total_mass(const Body& body, double common) {
  if (body.density.empty()) return static_cast<double>(body.rest.size()) * common;
  double sum = 0;
  for (const double density : body.density) sum += density;
  return sum * common;
}

Material lightest(const Body& body) {
  Material material = body.material;
  if (!body.density.empty())
    material.mass *= *std::min_element(body.density.begin(), body.density.end());
  return material;
}

}  // namespace sinew
