// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/fill/detail/relax.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/cell_grid.h>
#include <sinew/core/parallel.h>

namespace sinew {
namespace {

constexpr std::size_t points_at_a_time = 1024;
constexpr double skin = 0.4;          // fraction of D: how much farther lists reach
constexpr double longest_move = 0.1;  // fraction of D that a particle moves at most in a step
constexpr double first_step = 0.1, longest_step = 1;  // mass 1, stiffness 1 / D
constexpr double first_mixing = 0.1;
constexpr int patience = 5;  // steps downhill before they grow longer

/// A minimization by FIRE. Lengths are in D.
class Relaxation {
 public:
  Relaxation(Points& points, const RelaxOptions& options)
      : points_(points),
        options_(options),
        force_(points.size(), Vec3::Zero()),
        velocity_(points.size(), Vec3::Zero()) {}

  void run() {
    for (int step = 0; step < options_.max_steps; ++step) {
      find_forces();
      if (largest(force_) < options_.enough) return;
      steer();
      move();
    }
  }

 private:
  template <class Visit>
  void for_each(const Visit& visit) const {
    parallel_for(points_.size(), points_at_a_time, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) visit(i);
    });
  }
  double sum(const std::function<double(std::size_t)>& of) const {
    return parallel_sum(points_.size(), points_at_a_time, [&](std::size_t begin, std::size_t end) {
      double part = 0;
      for (std::size_t i = begin; i < end; ++i) part += of(i);
      return part;
    });
  }
  static double largest(const Points& of) {
    double most = 0;
    for (const Vec3& one : of) most = std::max(most, one.squaredNorm());
    return std::sqrt(most);
  }

  void find_forces() {
    if (lists_.size() == 0 || moved_ > skin / 2) {
      lists_ = neighbors_within(points_, (1 + skin) * options_.distance);
      moved_ = 0;
    }
    for_each([&](std::size_t i) {
      if (options_.fixed[i] != 0) return;
      Vec3 sum = options_.field ? options_.field(i, points_[i]) : Vec3(Vec3::Zero());
      for (const std::uint32_t j : lists_.of(i)) {
        const Vec3 apart = (points_[i] - points_[j]) / options_.distance;
        const double d = apart.norm();
        if (d < 1 && d > 0) sum += (1 / d - 1) * apart;
      }
      force_[i] = sum;
    });
  }

  /// Turns the velocity towards the force, or stops where it leads uphill.
  void steer() {
    const double power = sum([&](std::size_t i) { return force_[i].dot(velocity_[i]); });
    if (power < 0) {
      std::fill(velocity_.begin(), velocity_.end(), Vec3::Zero());
      step_ /= 2, mixing_ = first_mixing, downhill_ = 0;
      return;
    }
    const double forces = sum([&](std::size_t i) { return force_[i].squaredNorm(); });
    const double speeds = sum([&](std::size_t i) { return velocity_[i].squaredNorm(); });
    const double turn = mixing_ * std::sqrt(speeds / forces);
    for_each(
        [&](std::size_t i) { velocity_[i] = (1 - mixing_) * velocity_[i] + turn * force_[i]; });
    if (++downhill_ > patience) {
      step_ = std::min(1.1 * step_, longest_step);
      mixing_ *= 0.99;
    }
  }

  void move() {
    for_each([&](std::size_t i) { velocity_[i] += step_ * force_[i]; });
    const double most = step_ * largest(velocity_);
    const double by = step_ * std::min(1.0, longest_move / std::max(most, longest_move));
    moved_ += std::min(most, longest_move);
    for_each([&](std::size_t i) { points_[i] += by * options_.distance * velocity_[i]; });
  }

  Points& points_;
  const RelaxOptions& options_;
  Points force_, velocity_;
  NeighborLists lists_;
  double moved_ = 0;  ///< at most, since the lists were made
  double step_ = first_step, mixing_ = first_mixing;
  int downhill_ = 0;
};

}  // namespace

void relax(Points& points, const RelaxOptions& options) { Relaxation(points, options).run(); }

}  // namespace sinew
