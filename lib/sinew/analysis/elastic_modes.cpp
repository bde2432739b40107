// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/analysis/elastic_modes.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <sinew/analysis/detail/held_body.h>
#include <sinew/analysis/detail/nearly_solved.h>
#include <sinew/body/bond_factors.h>
#include <sinew/core/cell_grid.h>
#include <sinew/core/decompositions.h>
#include <sinew/core/particles.h>
#include <sinew/core/union_find.h>
#include <sinew/world/world.h>

namespace sinew {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr Eigen::Index kept_modes = 6, answers = 4;  // see ModeFinder::widen()
constexpr double max_particles = 8'000;              // larger bodies are coarsened to that many ...
constexpr double min_layers = 9;                     // ... as long as they keep these across
constexpr double max_iterated = 200'000;             // particles: more take gigabytes and minutes
constexpr std::size_t min_bonds = 3;                 // fewer do not hold a particle
constexpr int max_rounds = 60, order = 3;            // order of the polynomials to begin with
constexpr double converged = 1e-4;                   // relative change of eigenvalues
constexpr double free_motion = 1e-8;  // fraction of a rigid motion's largest energy: not held
constexpr int max_bends = 8;
constexpr double floppy = 1e-3;  // fraction of a smooth mode's w^2 below which one is no mode

/// Returns the indices of the particles in the largest part that hangs together.
std::vector<std::size_t> largest_part(const Body& body) {
  const SharedNeighbors shared = neighbors_of(body);
  const NeighborLists& near = shared->nearest;
  UnionFind sets(body.rest.size());
  for (std::size_t i = 0; i < body.rest.size(); ++i)
    for (const std::uint32_t j : near.of(i))
      if (near.of(i).size() >= min_bonds && near.of(j).size() >= min_bonds)
        sets.join(static_cast<std::int32_t>(i), static_cast<std::int32_t>(j));
  std::vector<std::vector<std::size_t>> parts(body.rest.size());
  for (std::size_t i = 0; i < body.rest.size(); ++i)
    parts[static_cast<std::size_t>(sets.first_of(static_cast<std::int32_t>(i)))].push_back(i);
  return *std::max_element(parts.begin(), parts.end(),
                           [](const auto& a, const auto& b) { return a.size() < b.size(); });
}

Body part_of(const Body& body, const std::vector<std::size_t>& places) {
  Body part;
  part.material = body.material;
  part.lattice = body.lattice;
  for (const std::size_t i : places) {
    part.rest.push_back(body.rest[i]);
    if (!body.volume_share.empty()) part.volume_share.push_back(body.volume_share[i]);
    if (!body.stiffness.empty()) part.stiffness.push_back(body.stiffness[i]);
    if (!body.density.empty()) part.density.push_back(body.density[i]);
    if (!body.local.volume.empty()) part.local.volume.push_back(body.local.volume[i]);
  }
  part.neighbors = neighbors_of(part);
  part.factors = bond_factors(part.rest, *part.neighbors, part.material, part.volume_share,
                              part.stiffness, part.local.volume);
  return part;
}

/// Displacements by polynomials of the rest positions.
Matrix polynomials(const Points& rest) {
  Box box;
  for (const Vec3& place : rest) box.extend(place);
  const double half = std::max(box.sizes().maxCoeff() / 2, 1e-300);
  std::vector<std::array<int, 3>> powers;
  for (int i = 0; i <= order; ++i)
    for (int j = 0; i + j <= order; ++j)
      for (int k = 0; i + j + k <= order; ++k) powers.push_back({i, j, k});
  Matrix all = Matrix::Zero(3 * static_cast<Eigen::Index>(rest.size()),
                            3 * static_cast<Eigen::Index>(powers.size()));
  for (std::size_t n = 0; n < rest.size(); ++n) {
    const Vec3 x = (rest[n] - box.center()) / half;
    for (std::size_t p = 0; p < powers.size(); ++p) {
      double value = 1;
      for (int axis = 0; axis < 3; ++axis) value *= std::pow(x[axis], powers[p][axis]);
      for (int axis = 0; axis < 3; ++axis)
        all(3 * static_cast<Eigen::Index>(n) + axis, 3 * static_cast<Eigen::Index>(p) + axis) =
            value;
    }
  }
  return all;
}

Matrix rigid_motions(const Points& rest) {
  Vec3 center = Vec3::Zero();
  for (const Vec3& place : rest) center += place / static_cast<double>(rest.size());
  Matrix all(3 * static_cast<Eigen::Index>(rest.size()), 6);
  for (std::size_t n = 0; n < rest.size(); ++n)
    for (int axis = 0; axis < 3; ++axis) {
      all.block<3, 1>(3 * static_cast<Eigen::Index>(n), axis) = Vec3::Unit(axis);
      all.block<3, 1>(3 * static_cast<Eigen::Index>(n), 3 + axis) =
          Vec3::Unit(axis).cross(rest[n] - center);
    }
  return all;
}

/// The lowest modes by a block Davidson method: Ritz vectors among them and their residuals, which
/// the springs alone precondition.
class ModeFinder {
 public:
  /// `shapes`: modes wanted with them.
  ModeFinder(const Body& body, const Vector& mass, Holding holding, int shapes)
      : body_(body, mass, std::move(holding)),
        judged_(std::max<Eigen::Index>(2, shapes)),
        kept_(std::max<Eigen::Index>(kept_modes, shapes + 3)),
        shapes_(shapes),
        rigid_(free_to_move(orthonormal(rigid_motions(body.rest)))) {}

  ElasticModes find() {
    Matrix basis = orthonormal(elastic(polynomials(body_.body().rest)));
    if (basis.cols() == 0) return {};
    ritz(basis);
    if (body_.held()) bend_where_held(basis);
    const double smooth = squared_[0];
    const NearlySolved solver(body_, 0.1 * smooth);
    if (!solver.sound()) return result();
    for (int round = 0; round < max_rounds; ++round) {
      const Vector before = squared_;
      const Matrix residual = stiffness_ - body_.with_mass(modes_) * squared_.asDiagonal();
      const Matrix corrections = elastic(solver.solve(residual));
      Matrix wider(modes_.rows(), modes_.cols() + corrections.cols());
      wider << modes_, corrections;
      ritz(orthonormal(wider));
      const Eigen::Index same = std::min(before.size(), squared_.size());
      const Eigen::Index judged = std::min(same, judged_);
      if ((squared_.head(judged) - before.head(judged)).cwiseAbs().maxCoeff() <
          converged * std::abs(squared_[judged - 1]))
        break;
    }
    forget_floppy(smooth);
    widen(solver);
    return result();
  }

 private:
  /// Selects the rigid motions that nothing holds.
  Matrix free_to_move(const Matrix& rigid) const {
    if (!body_.held()) return rigid;
    const auto [values, vectors] = eigendecomposition(body_.held_energy(rigid));
    Eigen::Index free = 0;
    while (free < values.size() && values[free] < free_motion * values.tail(1)[0]) ++free;
    return rigid * vectors.leftCols(free);
  }

  /// Polynomials do not end where a body is held: their static answers do.
  void bend_where_held(const Matrix& polynomial) {
    for (int n = 0; n < max_bends; ++n) {
      const double before = squared_[0];
      const NearlySolved solver(body_, 0.1 * before);
      if (!solver.sound()) return;
      const Matrix responses = elastic(solver.solve(body_.with_mass(n == 0 ? polynomial : modes_)));
      Matrix wider(responses.rows(), responses.cols() + modes_.cols());
      wider << responses, modes_;
      ritz(orthonormal(wider));
      if (squared_[0] > 0.5 * before) return;
    }
  }

  /// With respect to the masses; what depends on others is left out.
  Matrix orthonormal(const Matrix& from) const {
    const Matrix even = of_norm_1(from);
    const auto [values, vectors] = eigendecomposition(even.transpose() * body_.with_mass(even));
    Eigen::Index dependent = 0;
    while (dependent < values.size() && values[dependent] < 1e-10) ++dependent;
    const Eigen::Index left = values.size() - dependent;
    return even * vectors.rightCols(left) *
           values.tail(left).cwiseSqrt().cwiseInverse().asDiagonal();
  }

  Vector norms(const Matrix& of) const {
    return of.cwiseProduct(body_.with_mass(of)).colwise().sum().cwiseMax(1e-300).cwiseSqrt();
  }

  Matrix of_norm_1(const Matrix& from) const {
    return from * norms(from).cwiseInverse().asDiagonal();
  }

  /// What neither is held nor moves as a whole; without the columns that are nothing else.
  Matrix elastic(const Matrix& from) const {
    return without_rigid(body_.held() ? body_.free_part(from) : from);
  }

  Matrix without_rigid(const Matrix& from) const {
    Matrix left = of_norm_1(from);
    for (int twice = 0; twice < 2; ++twice)
      left -= rigid_ * (rigid_.transpose() * body_.with_mass(left));
    const Vector norm = norms(left);
    Eigen::Index kept = 0;
    for (Eigen::Index n = 0; n < left.cols(); ++n)
      if (norm[n] > 1e-6) left.col(kept++) = left.col(n).eval();
    return left.leftCols(kept);
  }

  /// Damping bends the lowest mode out of the span of a few elastic ones. Adds how: the static
  /// answers to its damping, to the damping of that, and so on.
  void widen(const NearlySolved& solver) {
    Matrix wider = modes_, answer = modes_.col(0);
    for (Eigen::Index n = 0; n < answers; ++n) {
      answer = elastic(solver.solve_well(body_.damping(answer)));
      if (answer.cols() == 0) break;
      wider.conservativeResize(Eigen::NoChange, wider.cols() + 1);
      wider.rightCols(1) = answer;
    }
    ritz(orthonormal(wider), wider.cols());
  }

  /// The lowest modes within the span of an orthonormal basis.
  void ritz(const Matrix& basis) { ritz(basis, kept_); }
  void ritz(const Matrix& basis, Eigen::Index most) {
    const Matrix forces = body_.stiffness(basis);
    Matrix reduced = basis.transpose() * forces;
    reduced = (reduced + reduced.transpose()).eval() / 2;
    const auto [values, vectors] = eigendecomposition(reduced);
    const Eigen::Index count = std::min(most, basis.cols());
    squared_ = values.head(count);
    modes_ = basis * vectors.leftCols(count);
    stiffness_ = forces * vectors.leftCols(count);
  }

  void forget_floppy(double smooth) {
    Eigen::Index first = 0;
    while (first + 1 < squared_.size() && squared_[first] < floppy * smooth) ++first;
    const Eigen::Index count = squared_.size() - first;
    squared_ = squared_.tail(count).eval();
    modes_ = modes_.rightCols(count).eval();
  }

  ElasticModes result() {
    ElasticModes found{squared_, modes_.transpose() * body_.damping(modes_),
                       modes_.transpose() * body_.damping_of_bones(modes_)};
    for (Eigen::Index n = 0; n < std::min(shapes_, modes_.cols()); ++n) {
      Points& shape = found.shapes.emplace_back();
      for (Eigen::Index i = 0; i < modes_.rows(); i += 3)
        shape.push_back(modes_.col(n).segment<3>(i));
    }
    return found;
  }

  HeldBody body_;
  Eigen::Index judged_, kept_, shapes_;
  Matrix rigid_;
  Matrix modes_, stiffness_;  ///< u and K u
  Vector squared_;
};

/// Finds the modes of a body small enough; masses in proportion to the volume shares, or all equal.
ElasticModes modes_of(const Body& whole, const Holding& holding, bool by_volume, int shapes) {
  const std::vector<std::size_t> places = largest_part(whole);
  const Body body = part_of(whole, places);
  const auto n = static_cast<Eigen::Index>(body.rest.size());
  if (n < 2) return {};
  Vector mass(3 * n);
  double sum = 0;
  for (const double volume_share : body.volume_share) sum += volume_share;
  for (Eigen::Index i = 0; i < n; ++i)
    mass.segment<3>(3 * i).setConstant(
        mass_of(body, static_cast<std::size_t>(i), body.material.mass) *
        (by_volume ? body.volume_share[static_cast<std::size_t>(i)] * static_cast<double>(n) / sum
                   : 1));
  ElasticModes found = ModeFinder(body, mass, holding.part(places), shapes).find();
  for (Points& shape : found.shapes) {
    Points all(whole.rest.size(), Vec3::Zero());
    for (std::size_t k = 0; k < places.size(); ++k) all[places[k]] = shape[k];
    shape = std::move(all);
  }
  return found;
}

/// Values at `places` of those at points of a packing, `spacing` (m) apart: means, by nearness.
Points interpolated(const Points& values, const Points& at, double spacing, const Points& places) {
  Points all(places.size(), Vec3::Zero());
  const double range = 1.5 * spacing;
  const CellGrid grid(at, range);
  for (std::size_t i = 0; i < places.size(); ++i) {
    double sum = 0;
    grid.for_each_near(places[i], [&](std::uint32_t j) {
      const double weight = std::max(0.0, 1 - (at[j] - places[i]).norm() / range);
      all[i] += weight * weight * values[j];
      sum += weight * weight;
    });
    if (sum > 0) all[i] /= sum;
  }
  return all;
}

/// The modes of a packing `times` as coarse, with rates as of the body.
ElasticModes coarse_modes(const Body& body, int times, int shapes) {
  const Body coarse = coarse_body(body, times);
  const Holding holding =
      spread_onto(coarse.rest, 2 * coarse.material.pair.r, body.rest, holding_of(body));
  ElasticModes modes = modes_of(coarse, holding, true, shapes);
  for (Points& shape : modes.shapes)
    shape = interpolated(shape, coarse.rest, 2 * coarse.material.pair.r, body.rest);
  const double finer = body.material.pair.r / coarse.material.pair.r;
  modes.rates *= finer * finer * static_cast<double>(body.rest.size()) /
                 static_cast<double>(coarse.rest.size());
  return modes;
}

}  // namespace

namespace {

/// Whether all neighbors touch, as in packings that are no lattice they do not.
bool is_closest(const Body& body, const NeighborLists& near) {
  const double touching = 2 * body.material.pair.r;
  for (std::uint32_t i = 0; i < near.size(); ++i)
    for (const std::uint32_t j : near.of(i))
      if (std::abs((body.rest[j] - body.rest[i]).norm() - touching) > 1e-3 * touching) return false;
  return true;
}

}  // namespace

double layers_across(const Body& body) {
  const SharedNeighbors shared = neighbors_of(body);
  const NeighborLists& near = shared->nearest;
  if (!is_closest(body, near)) return std::numeric_limits<double>::infinity();
  const std::size_t n = body.rest.size();
  std::vector<std::uint32_t> order;  // particles from the surface inward
  std::vector<int> depth(n, -1);
  order.reserve(n);
  const auto reach = [&](std::uint32_t i, int layer) {
    if (depth[i] >= 0) return;
    depth[i] = layer;
    order.push_back(i);
  };
  for (std::uint32_t i = 0; i < n; ++i)
    if (near.of(i).size() < max_neighbors_at_rest) reach(i, 0);
  for (std::size_t k = 0; k < order.size(); ++k)
    for (const std::uint32_t j : near.of(order[k])) reach(j, depth[order[k]] + 1);
  // The deepest layer inward of each particle, by two hops at a time: below a corner, the next
  // layer is no neighbor.
  std::vector<int> deepest = depth;
  for (auto i = order.rbegin(); i != order.rend(); ++i)
    for (const std::uint32_t j : near.of(*i))
      for (const std::uint32_t k : near.of(j))
        if (depth[k] > depth[*i]) deepest[*i] = std::max(deepest[*i], deepest[k]);
  if (deepest.empty()) return 0;
  const auto thin = deepest.begin() + static_cast<std::ptrdiff_t>(n / 10);
  std::nth_element(deepest.begin(), thin, deepest.end());
  return 2.0 * *thin + 1;
}

double ElasticModes::frequency() const { return empty() ? 0 : std::sqrt(squared[0]); }

double ElasticModes::ratio_of(const Matrix& damping) const {
  if (empty() || !(damping(0, 0) > 0)) return 0;
  const Eigen::Index n = squared.size();
  Matrix first_order = Matrix::Zero(2 * n, 2 * n);
  first_order.topRightCorner(n, n).setIdentity();
  first_order.bottomLeftCorner(n, n) = -Matrix(squared.asDiagonal());
  std::complex<double> at(0, frequency());
  // Followed in steps from where it is damped little.
  const double begin = std::min(1.0, 0.02 * frequency() / damping(0, 0));
  const int steps = 1 + static_cast<int>(std::ceil(std::log(1 / begin) / std::log(1.15)));
  for (int step = 0; step < steps; ++step) {
    const double share = steps == 1 ? 1 : begin * std::pow(1 / begin, step / (steps - 1.0));
    first_order.bottomRightCorner(n, n) = -share * damping;
    const Eigen::VectorXcd values = eigenvalues_of_any(first_order);
    std::complex<double> nearest = values[0];
    for (const std::complex<double>& value : values)
      if (value.imag() >= 0 && std::abs(value - at) < std::abs(nearest - at)) nearest = value;
    at = nearest;
  }
  return -at.real() / std::abs(at);
}

double ElasticModes::damping_ratio(double damping, double rate) const {
  if (empty()) return 0;
  return ratio_of(damping * rates + rates_of_bones +
                  rate * Matrix::Identity(squared.size(), squared.size()));
}

namespace {

constexpr double max_followed = 0.9;  // ratios beyond are in proportion

/// Where a ratio that grows from 0 reaches `wanted`; `first`: where it might.
template <class Ratio>
double reached(double wanted, double first, Ratio ratio) {
  double low = 0, high = first;
  for (int n = 0; n < 20 && ratio(high) < wanted; ++n) low = high, high *= 1.5;
  for (int n = 0; n < 40; ++n) {
    const double middle = (low + high) / 2;
    (ratio(middle) < wanted ? low : high) = middle;
  }
  return high;
}

}  // namespace

double ElasticModes::damping_for(double ratio) const {
  if (empty() || !(ratio > 0) || !(rates(0, 0) > 0)) return 0;
  const double wanted = std::min(ratio, max_followed);
  if (damping_ratio(0) >= wanted) return 0;
  const double first = 2 * wanted * frequency() / rates(0, 0);
  return ratio / wanted * reached(wanted, first, [&](double C) { return damping_ratio(C); });
}

double ElasticModes::rate_for(double ratio, double damping) const {
  const double wanted = std::min(ratio, max_followed);
  if (empty() || !(ratio > 0) || damping_ratio(damping) >= wanted) return 0;
  return ratio / wanted * reached(wanted, 2 * wanted * frequency(), [&](double rate) {
           return damping_ratio(damping, rate);
         });
}

ElasticModes elastic_modes(const Body& body, int shapes) {
  const auto count = static_cast<double>(body.rest.size());
  int times = 1;
  while (count / std::pow(times, 3) > max_particles) ++times;
  if (times > 1)
    times = static_cast<int>(std::clamp(layers_across(body) / min_layers, 1.0, 1.0 * times));
  if (count / std::pow(times, 3) > max_iterated) return {};
  ElasticModes found = times == 1 ? modes_of(body, holding_of(body), false, shapes)
                                  : coarse_modes(body, times, shapes);
  for (Points& shape : found.shapes) {
    double largest = 0;
    for (const Vec3& u : shape) largest = std::max(largest, u.norm());
    for (Vec3& u : shape) u /= std::max(largest, 1e-300);
  }
  return found;
}

std::string held_by(const Body& body) {
  bool pins = false, supports = false, bones = false;
  if (body.world)
    for (const Pinned& pin : body.world->pins)
      (pin.is_pin() && !pin.is_oblique() ? pins : supports) = true;
  for (const Influence& by : body.binding.influences)
    bones = bones || body.springs[static_cast<std::size_t>(by.bone)].stiffest() > 0;
  std::string all;
  for (const auto& [holds, name] :
       {std::pair(bones, "bones"), {pins, "pins"}, {supports, "supports"}})
    if (holds) all += (all.empty() ? "" : " and ") + std::string(name);
  return all.empty() ? "nothing" : all;
}

}  // namespace sinew
