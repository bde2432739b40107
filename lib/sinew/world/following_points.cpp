// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/world/following_points.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <sinew/core/cell_grid.h>
#include <sinew/core/decompositions.h>
#include <sinew/core/error.h>
#include <sinew/core/local_origin.h>
#include <sinew/core/parallel.h>
#include <sinew/core/triangles.h>

namespace sinew {
namespace {

constexpr std::size_t points_per_task = 64;
constexpr double first_reach = 6;         // radii, within which that many are looked for
constexpr double beyond_farthest = 1.05;  // reach of the weights over that of the farthest
constexpr double flat = 1e-3;             // second moment over the largest that counts as none

struct Near {
  double squared;
  std::uint32_t particle;
  bool operator<(const Near& other) const {
    return std::pair(squared, particle) < std::pair(other.squared, other.particle);
  }
};

/// The `count` nearest particles of a place, nearest first; fewer where the body has fewer.
class Finder {
 public:
  Finder(const Points& rest, double radius) : rest_(rest) {
    if (rest.empty()) throw bad_input("the body has no particles", "make its radius smaller");
    const double all = 2 * bounds(rest).diagonal().norm() + radius;
    for (double reach = first_reach * radius;; reach *= 4) {
      reach_.push_back(reach);
      grids_.emplace_back(rest, reach);
      if (reach > all) break;
    }
  }

  std::vector<Near> nearest(const Vec3& place, std::size_t count) const {
    const std::size_t wanted = std::min(count, rest_.size());
    std::vector<Near> found;
    for (std::size_t k = 0; k < grids_.size() && found.size() < wanted; ++k)
      found = within(place, k);
    if (found.size() < wanted) found = everywhere(place);
    const auto last = found.begin() + static_cast<std::ptrdiff_t>(wanted);
    std::partial_sort(found.begin(), last, found.end());
    found.erase(last, found.end());
    return found;
  }

 private:
  void add(const Vec3& place, std::uint32_t j, double most, std::vector<Near>& found) const {
    const double squared = (rest_[j] - place).squaredNorm();
    if (squared <= most) found.push_back({squared, j});
  }

  std::vector<Near> within(const Vec3& place, std::size_t k) const {
    std::vector<Near> found;
    grids_[k].for_each_near(place,
                            [&](std::uint32_t j) { add(place, j, reach_[k] * reach_[k], found); });
    return found;
  }

  /// For places far outside of the body.
  std::vector<Near> everywhere(const Vec3& place) const {
    std::vector<Near> found;
    for (std::uint32_t j = 0; j < rest_.size(); ++j) add(place, j, HUGE_VAL, found);
    return found;
  }

  const Points& rest_;
  std::vector<double> reach_;
  std::vector<CellGrid> grids_;  ///< each reaches four times as far as the one before
};

/// The inverse of the second moments, 0 along directions in which there are none.
Mat3 inverse_of(const Mat3& moments) {
  const auto [values, axes] = principal_axes(moments);
  Mat3 inverse = Mat3::Zero();
  for (int k = 0; k < 3; ++k) {
    if (!(values[k] > flat * values[2])) continue;
    const Vec3 axis = axes.col(k);
    inverse += axis * axis.transpose() / values[k];
  }
  return inverse;
}

std::vector<double> weights_at(const Vec3& place, const std::vector<Near>& near,
                               const Points& rest) {
  const double h2 = beyond_farthest * beyond_farthest * near.back().squared;
  std::vector<double> weights;
  double sum = 0;
  Vec3 mean = Vec3::Zero();
  for (const Near& one : near) {
    const double s = h2 > 0 ? 1 - one.squared / h2 : 1;
    weights.push_back(s * s * s);
    sum += weights.back();
    mean += weights.back() * (rest[one.particle] - place);
  }
  mean = place + mean / sum;
  Mat3 moments = Mat3::Zero();
  for (std::size_t k = 0; k < near.size(); ++k) {
    const Vec3 arm = rest[near[k].particle] - mean;
    moments += weights[k] / sum * arm * arm.transpose();
  }
  const Vec3 slope = inverse_of(moments) * (place - mean);
  for (std::size_t k = 0; k < near.size(); ++k)
    weights[k] *= (1 + slope.dot(rest[near[k].particle] - mean)) / sum;
  return weights;
}

Points less(Points points, const Vec3& shift) {
  for (Vec3& point : points) point -= shift;
  return points;
}

}  // namespace

Points FollowingPoints::at(const Points& now) const {
  Points places(size());
  parallel_for(size(), points_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      Vec3 place = Vec3::Zero();
      for (std::uint32_t e = first[k]; e < first[k + 1]; ++e)
        place += weight[e] * (now[particle[e]] - origin);
      places[k] = origin + place;
    }
  });
  return places;
}

FollowingPoints following(const Points& places, const Points& rest, double radius,
                          std::size_t count) {
  const Vec3 origin = local_origin(bounds(rest));
  if (!origin.isZero(0)) {
    FollowingPoints near = following(less(places, origin), less(rest, origin), radius, count);
    near.origin = origin;
    return near;
  }
  const Finder finder(rest, radius);
  FollowingPoints points;
  const std::size_t each = std::min(count, rest.size());
  points.particle.resize(each * places.size());
  points.weight.resize(each * places.size());
  for (std::size_t k = 0; k <= places.size(); ++k)
    points.first.push_back(static_cast<std::uint32_t>(each * k));
  parallel_for(places.size(), points_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::vector<Near> near = finder.nearest(places[k], each);
      const std::vector<double> weights = weights_at(places[k], near, rest);
      for (std::size_t n = 0; n < each; ++n) {
        points.particle[each * k + n] = near[n].particle;
        points.weight[each * k + n] = weights[n];
      }
    }
  });
  return points;
}

std::vector<std::uint32_t> nearest_particles(const Points& places, const Points& rest,
                                             double radius) {
  const Finder finder(rest, radius);
  std::vector<std::uint32_t> nearest(places.size());
  parallel_for(places.size(), points_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      nearest[k] = finder.nearest(places[k], 1).front().particle;
  });
  return nearest;
}

}  // namespace sinew
