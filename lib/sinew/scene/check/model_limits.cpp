// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/check/model_limits.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <sinew/core/text.h>
#include <sinew/core/triangles.h>
#include <sinew/material/elasticity.h>
#include <sinew/material/material.h>
#include <sinew/world/world.h>

namespace sinew {
namespace {

// A crack that grows in a double cantilever, over the energy of the bonds that are cut.
constexpr double crack_factor_low = 3.2, crack_factor_high = 3.6;
// What bulk_compression_factor() says over what skins of bodies show, mostly; 0.86 has been seen.
constexpr double smallest_excess = 1.15, largest_excess = 1.6;
// Degrees of a slope on which a block rests without friction: layers interlock.
constexpr double interlocking_slope = 20;

/// Places of what a support holds at rest, as a box.
Box box_of(const Support& support, const Points& rest) {
  Box box;
  for (const std::uint32_t i : support.particles) box.extend(rest[i]);
  return box;
}

bool has_several_components(const std::vector<std::int32_t>& component) {
  return std::any_of(component.begin(), component.end(),
                     [&](std::int32_t one) { return one != component.front(); });
}

/// Layers across a cube that has as much surface for its volume.
double layers_of_equal_cube(const Triangles& surface, double r) {
  return 6 * std::abs(volume(surface)) / (area(surface) * half_plane_spacing(r));
}

}  // namespace

double grip_factor(const Body& body) {
  if (!body.world) return 1;
  const double layer = half_plane_spacing(body.material.pair.r);
  double largest = 1;
  const std::vector<Support>& supports = body.world->supports;
  for (std::size_t k = 0; k < supports.size(); ++k)
    for (std::size_t m = 0; m < k; ++m) {
      const Box a = box_of(supports[k], body.rest), b = box_of(supports[m], body.rest);
      int axis = 0;
      const double apart = (a.center() - b.center()).cwiseAbs().maxCoeff(&axis);
      const auto along = static_cast<std::size_t>(axis);
      const bool thin =
          std::max(a.sizes()[axis], b.sizes()[axis]) < layer;  // others end in a layer
      if (!thin || !supports[k].holds[along] || !supports[m].holds[along] || apart < 2 * layer)
        continue;
      largest = std::max(largest, (apart + layer) / (apart - layer));
    }
  return largest;
}

/// Measured on cubes of 7, 13 and 21 layers, by the volume of their particles: 1.12, 1.05, 1.02 at
/// a ratio of 0.3; 2.19, 1.58, 1.30 at 0.45; 3.50, 2.47, 1.73 at 0.49.
double bulk_compression_factor(double layers, double poisson_ratio) {
  constexpr double slope = 2.8, saturation = 0.123;
  const double bonds_alone = 1 / (1 - 2 * isotropic_poisson);
  const double beyond = 1 / (1 - 2 * poisson_ratio) / bonds_alone - 1;  // share of the bulk modulus
  return 1 + std::max(0.0, slope * beyond / (1 + saturation * beyond)) / layers;
}

std::vector<ModelLimit> model_limits(const Prepared& prepared) {
  const Body& body = prepared.body;
  const MaterialOptions& material = prepared.settings.material;
  std::vector<ModelLimit> limits;
  if (material.fracture_energy)
    limits.push_back({"crack_energy_factor", (crack_factor_low + crack_factor_high) / 2,
                      "times fracture_energy, which is that of the bonds that are cut, for a crack "
                      "that grows: " +
                          three_digits(crack_factor_low) + " to " +
                          three_digits(crack_factor_high)});
  if (keeps_volume(body) && !prepared.surface.triangles.faces.empty()) {
    const double layers = layers_of_equal_cube(prepared.surface.triangles, body.material.pair.r);
    const double factor = bulk_compression_factor(layers, material.poisson_ratio);
    limits.push_back({"bulk_compression_factor", factor,
                      "times as much as the bulk modulus says, under a pressure all around: the "
                      "skin of a body with the surface of a cube of " +
                          three_digits(layers) +
                          " layers gives way, by the volume of its particles; by that of its skin "
                          "(volume_error) "
                          "mostly " +
                          three_digits(std::max(1.0, factor / largest_excess)) + " to " +
                          three_digits(std::max(1.0, factor / smallest_excess)) +
                          " times, which scatters with how the packing lies"});
  }
  if (material.friction > 0 || has_several_components(prepared.filled.component))
    limits.push_back({"friction_floor", std::tan(interlocking_slope * std::numbers::pi / 180),
                      "at least, between bodies of particles, whose layers interlock"});
  if (const double factor = grip_factor(body); factor > 1)
    limits.push_back({"grip_factor", factor,
                      "times too stiff between supports that hold a layer each: a layer at each "
                      "end does not stretch"});
  return limits;
}

}  // namespace sinew
