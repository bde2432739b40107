// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/body/body.h>

#include <algorithm>

namespace sinew {

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
