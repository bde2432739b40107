// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/stepping/detail/newton.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <sinew/body/step_plan.h>
#include <sinew/stepping/equilibrium.h>
#include <sinew/world/features.h>
#include <sinew/world/world.h>

namespace sinew {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// A correction may turn or strain any pair by so much: by more, the tangent says nothing.
constexpr double max_correction = 0.3;

/// Particles that are as many bonds from one end of a piece of the body.
struct Layer {
  std::size_t size = 0;
  Vec3 middle = Vec3::Zero();  ///< m
  bool first = false;          ///< first of its piece
};

Layer layer_of(const std::vector<std::uint32_t>& particles, const Points& rest) {
  Layer layer{particles.size()};
  for (const std::uint32_t i : particles) layer.middle += rest[i];
  layer.middle /= static_cast<double>(particles.size());
  return layer;
}

/// The layers of all pieces, from one end of each on.
std::vector<Layer> layers_of(const NeighborLists& near, const Points& rest) {
  std::vector<Layer> all;
  std::vector<bool> seen(near.size(), false);
  const auto layers_from = [&](std::uint32_t start, std::vector<bool>& met) {
    std::vector<std::vector<std::uint32_t>> layers = {{start}};
    met[start] = true;
    while (true) {
      std::vector<std::uint32_t> next;
      for (const std::uint32_t i : layers.back())
        for (const std::uint32_t j : near.of(i))
          if (!met[j]) met[j] = true, next.push_back(j);
      if (next.empty()) return layers;
      layers.push_back(std::move(next));
    }
  };
  for (std::uint32_t i = 0; i < near.size(); ++i) {
    if (seen[i]) continue;
    std::vector<bool> met = seen;
    const std::uint32_t end = layers_from(i, met).back().front();
    const std::size_t begin = all.size();
    for (const auto& particles : layers_from(end, seen)) all.push_back(layer_of(particles, rest));
    all[begin].first = true;
  }
  return all;
}

/// How many bonds the farthest particle is from what holds the body; infinite where nothing does.
double reach_of(const NeighborLists& near, const Body& body) {
  std::vector<std::uint32_t> layer;
  std::vector<bool> met(near.size(), false);
  const auto add = [&](std::uint32_t i, std::vector<std::uint32_t>& to) {
    if (!met[i]) met[i] = true, to.push_back(i);
  };
  if (body.world)
    for (const Pinned& pin : body.world->pins) add(pin.particle, layer);
  if (layer.empty()) return infinity;
  double reach = -1;
  while (!layer.empty()) {
    std::vector<std::uint32_t> next;
    for (const std::uint32_t i : layer)
      for (const std::uint32_t j : near.of(i)) add(j, next);
    layer = std::move(next);
    ++reach;
  }
  return reach;
}

/// Along the middles of the layers, m; of the longest piece.
double length_of(const std::vector<Layer>& layers) {
  double longest = 0, length = 0;
  for (std::size_t k = 0; k < layers.size(); ++k) {
    length = layers[k].first ? 0 : length + (layers[k].middle - layers[k - 1].middle).norm();
    longest = std::max(longest, length);
  }
  return longest;
}

/// Nonzeros of a factor whose unknowns are ordered layer by layer.
double banded_nonzeros(const std::vector<Layer>& layers, bool keeps_volume) {
  double all = 0, before = 0;
  for (const Layer& layer : layers) {
    const double unknowns = 3.0 * static_cast<double>(layer.size);
    const double width = unknowns * (keeps_volume ? 2 : 1);
    all += unknowns * (width / 2 + before);
    before = width;
  }
  return all;
}

}  // namespace

std::string why_not_newton(const Body& body, const Stepping& stepping) {
  Features features = features_of(body);
  if (stepping.precision == Precision::binary32) features.insert(Feature::single_precision);
  const auto conflict = conflict_with(Feature::newton, features);
  return conflict ? conflict->what : "";
}

StaticCost relaxation_cost(const Body& body, double residual) {
  // Measured: bars of 5 to 11 layers across and 5 to 30 times as long, under a force at an end. The
  // slowest mode of a bar of l pairs of layers, each of p particles, has a period of l^2 / sqrt(p);
  // held at both ends it moves like two of half the length.
  constexpr double slowness = 8, particles_per_second = 20e6;
  const auto count = static_cast<double>(body.rest.size());
  const double pair_of_layers = 2 * half_plane_spacing(body.material.pair.r);
  const SharedNeighbors neighbors = neighbors_of(body);
  const NeighborLists& near = neighbors->all();
  const double length = 1 + length_of(layers_of(near, body.rest)) / pair_of_layers;
  const double reach = std::min(length, 1 + reach_of(near, body));
  StaticCost cost;
  cost.iterations = slowness * reach * reach / std::sqrt(count / length) * -std::log(residual);
  cost.relaxation = cost.iterations * count / particles_per_second;
  return cost;
}

StaticCost with_factor(StaticCost cost, const Body& body) {
  constexpr double solutions = 6, products_per_second = 0.7e9;
  constexpr double too_large = 4 * max_factor;  // for an analysis; the band is an upper bound
  const SharedNeighbors near = neighbors_of(body);
  cost.nonzeros = banded_nonzeros(layers_of(near->all(), body.rest), keeps_volume(body));
  if (cost.nonzeros > too_large) return cost;
  const Particles particles = particles_at(body.rest, body.material.pair.r, body.material.mass);
  const Newton newton(body, *near, particles, Vec3::Zero());
  cost.nonzeros = newton.nonzeros();
  cost.newton = solutions * newton.products() / products_per_second;
  return cost;
}

Newton::Newton(const Body& body, const RestNeighbors& near, const Particles& particles,
               const Vec3& gravity)
    : tangent_(body, near, particles.id), gravity_(gravity) {
  particles_.radius = particles.radius;
  particles_.mass = particles.mass;
  particles_.id = particles.id;
  factor_.analyzePattern(tangent_.pattern());
}

const Points& Newton::read(Stepper& stepper, const TimedPose& now) {
  stepper.read(now, particles_);
  positions_.resize(particles_.size());
  for (std::size_t i = 0; i < positions_.size(); ++i) positions_[i] = particles_.position(i);
  return positions_;
}

std::optional<Newton::Solution> Newton::predict(Stepper& stepper, const TimedPose& begin,
                                                const TimedPose& soon, double part) {
  const Tangent::Matrix matrix = tangent_.at(stepper, begin, read(stepper, begin));
  const Tangent::Vector before = tangent_.forces(stepper, begin, gravity_),
                        after = tangent_.forces(stepper, soon, gravity_);
  auto solution = solve(matrix, before + (after - before) / part, {infinity, false});
  stepper.place(positions_, Stepper::Move::slight);
  return solution;
}

std::optional<Newton::Solution> Newton::correct(Stepper& stepper, const TimedPose& now) {
  const Tangent::Matrix matrix = tangent_.at(stepper, now, read(stepper, now));
  return solve(matrix, tangent_.forces(stepper, now, gravity_), {max_correction, true});
}

/// Solves by the sizes of the pivots: where the tangent is indefinite, energy falls all the same.
Tangent::Vector Newton::step_down(const Tangent::Vector& forces) const {
  Tangent::Vector by = factor_.permutationP() * forces;
  factor_.matrixL().solveInPlace(by);
  by = by.cwiseQuotient(factor_.vectorD().cwiseAbs());
  factor_.matrixU().solveInPlace(by);
  return factor_.permutationPinv() * by;
}

std::int64_t Newton::negative_pivots(Stepper& stepper, const TimedPose& now) {
  factor_.factorize(tangent_.at(stepper, now, read(stepper, now)));
  return (factor_.vectorD().array() < 0).count();
}

std::optional<Newton::Solution> Newton::solve(const Tangent::Matrix& matrix,
                                              const Tangent::Vector& forces, Step step) {
  factor_.factorize(matrix);
  if (factor_.info() != Eigen::Success) return std::nullopt;
  const std::int64_t negative = (factor_.vectorD().array() < 0).count();
  Tangent::Vector by = step.downhill && negative > 0 ? step_down(forces) : factor_.solve(forces);
  if (!by.allFinite()) return std::nullopt;
  const double gradient = tangent_.largest_gradient(positions_, by);
  if (gradient > step.max_gradient) by *= step.max_gradient / gradient;
  return Solution{tangent_.moved(positions_, by), negative};
}

}  // namespace sinew
