// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/fill/shares.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numeric>
#include <utility>

#include <sinew/core/fcc.h>
#include <sinew/core/particles.h>

namespace sinew {
namespace {

constexpr double finer = 1.5;  // radius of the particles over that of the samples
constexpr int rotations = 24;  // of a cube
constexpr double samples_per_particle = rotations * finer * finer * finer;
constexpr std::int32_t neighbors_inside = 12;
constexpr int reach = 3;  // steps of the lattice within which a sample belongs to a particle
constexpr double most_scaling = 1.25, least_share = 0.2;

/// An orientation along no plane or row of the lattice.
Mat3 oblique() {
  return (Eigen::AngleAxisd(0.731, Vec3::UnitZ()) * Eigen::AngleAxisd(0.417, Vec3::UnitY()) *
          Eigen::AngleAxisd(0.289, Vec3::UnitX()))
      .toRotationMatrix();
}

/// The rotations that bring a cube to itself. (A lattice is its own image under an inversion: with
/// these it is also under mirrors.)
std::vector<Mat3> rotations_of_a_cube() {
  std::vector<Mat3> found;
  std::array<int, 3> axes = {0, 1, 2};
  do
    for (int signs = 0; signs < 8; ++signs) {
      Mat3 turn = Mat3::Zero();
      for (int k = 0; k < 3; ++k) turn(axes[k], k) = (signs >> k & 1) != 0 ? -1 : 1;
      if (turn.determinant() > 0) found.push_back(turn);
    }
  while (std::next_permutation(axes.begin(), axes.end()));
  return found;
}

/// Finds filled sites by their place.
class SiteIndex {
 public:
  explicit SiteIndex(const FilledSites& filled)
      : lattice_(filled.lattice),
        runs_(filled.runs),
        first_run_(lattice_.rows.size() + 1),
        site_(runs_.size() + 1) {
    for (const Run& run : runs_) ++first_run_[static_cast<std::size_t>(run.row) + 1];
    std::partial_sum(first_run_.begin(), first_run_.end(), first_run_.begin());
    for (std::size_t i = 0; i < runs_.size(); ++i)
      site_[i + 1] = site_[i] + static_cast<std::size_t>(runs_[i].sites());
  }

  /// -1 for none.
  std::int64_t at(const LatticePlace& place) const {
    const std::int64_t row = lattice_.row_at(place[2], place[0] - place[1]);
    if (row < 0) return -1;
    const int n =
        (place[0] - lattice_.rows[static_cast<std::size_t>(row)].first[0]) / lattice_.along[0];
    const auto begin = runs_.begin() + static_cast<std::ptrdiff_t>(first_run_[row]),
               end = runs_.begin() + static_cast<std::ptrdiff_t>(first_run_[row + 1]);
    const auto run =
        std::partition_point(begin, end, [&](const Run& before) { return before.last <= n; });
    if (run == end || run->first > n) return -1;
    return static_cast<std::int64_t>(site_[static_cast<std::size_t>(run - runs_.begin())]) + n -
           run->first;
  }

 private:
  const Lattice& lattice_;
  const std::vector<Run>& runs_;
  std::vector<std::size_t> first_run_, site_;  ///< of each row; sites before each run
};

std::vector<LatticePlace> places_of(const FilledSites& filled) {
  const Lattice& lattice = filled.lattice;
  std::vector<LatticePlace> places(count_of(filled.runs));
  for_each_site(filled.runs, [&](std::size_t place, const Run& run, int n) {
    const LatticeRow& row = lattice.rows[static_cast<std::size_t>(run.row)];
    for (int axis = 0; axis < 3; ++axis)
      places[place][axis] = row.first[axis] + n * (axis < 2 ? lattice.along[axis] : 0);
  });
  return places;
}

/// The filled site nearest to a point, or -1.
std::int64_t owner(const SiteIndex& index, const Vec3& at) {
  static const std::vector<FccSite> around = fcc_steps(reach);
  const LatticePlace nearest = nearest_fcc_site(at);
  if (const std::int64_t own = index.at(nearest); own >= 0) return own;
  std::int64_t best = -1;
  double least = HUGE_VAL;
  for (const LatticePlace& step : around) {
    const LatticePlace place = {nearest[0] + step[0], nearest[1] + step[1], nearest[2] + step[2]};
    const double squared = (Vec3(place[0], place[1], place[2]) - at).squaredNorm();
    if (squared >= least) continue;
    const std::int64_t site = index.at(place);
    if (site >= 0) best = site, least = squared;
  }
  return best;
}

FilledSites samples_of(const BodySpace& space, PackOptions options, double radius) {
  options.count.reset();
  options.keep = Keep::center;
  options.clearance = 0;
  return fill_sites(space, options, radius);
}

/// Samples of the body by the particle that they are nearest to.
struct Sampled {
  std::vector<std::atomic<std::int32_t>> count;
  /// Sums of their offsets from it, in millionths of the lattice's unit: whole numbers, whose sums
  /// do not depend on their order.
  std::array<std::vector<std::atomic<std::int64_t>>, 3> offset;

  explicit Sampled(std::size_t sites) : count(sites) {
    for (auto& axis : offset) axis = std::vector<std::atomic<std::int64_t>>(sites);
  }

  void add(std::size_t site, const Vec3& from_it) {
    count[site].fetch_add(1, std::memory_order_relaxed);
    for (int axis = 0; axis < 3; ++axis)
      offset[axis][site].fetch_add(std::llround(1e6 * from_it[axis]), std::memory_order_relaxed);
  }
  double share(std::size_t site) const {
    return static_cast<double>(count[site]) / samples_per_particle;
  }
  /// Integral of the offset over the particle's part, in units of its volume and of the lattice.
  Vec3 moment(std::size_t site) const {
    Vec3 sum;
    for (int axis = 0; axis < 3; ++axis) sum[axis] = static_cast<double>(offset[axis][site]);
    return 1e-6 / samples_per_particle * sum;
  }
};

/// Moves weight between particles and their neighbors until linear functions are summed exactly: a
/// part that reaches far out takes from the neighbors behind.
void balance(const FilledSites& filled, const SiteIndex& index, const Touching& touching,
             const Sampled& sampled, std::vector<double>& share) {
  const std::vector<double> before = share;
  const std::vector<LatticePlace> places = places_of(filled);
  for (std::size_t i = 0; i < share.size(); ++i) {
    if (touching.neighbors[i] == neighbors_inside || sampled.count[i] == 0) continue;
    const Vec3 moment = before[i] / sampled.share(i) * sampled.moment(i);
    std::vector<std::pair<std::int64_t, Vec3>> around;
    Mat3 spread = Mat3::Zero();
    for (const LatticePlace& step : filled.lattice.nearest(places[i][2])) {
      const std::int64_t j =
          index.at({places[i][0] + step[0], places[i][1] + step[1], places[i][2] + step[2]});
      if (j < 0) continue;
      const Vec3 from = -Vec3(step[0], step[1], step[2]);
      around.emplace_back(j, from);
      spread += from * from.transpose();
    }
    if (spread.determinant() < 1) continue;  // a chain or a sheet has nothing behind
    const Vec3 by = spread.inverse() * moment;
    for (const auto& [j, from] : around) {
      const double moved = by.dot(from);
      share[i] += moved;
      share[static_cast<std::size_t>(j)] -= moved;
    }
  }
  for (double& one : share) one = std::max(one, least_share);
}

}  // namespace

std::vector<double> volume_shares(const Surface& surface, const PackOptions& options,
                                  const BodySpace& space, const FilledSites& filled,
                                  const Touching& touching, double volume) {
  const SiteIndex index(filled);
  const std::vector<LatticePlace> places = places_of(filled);
  Sampled sampled(touching.neighbors.size());
  const Lattice& lattice = filled.lattice;
  for (const Mat3& rotation : rotations_of_a_cube()) {
    PackOptions fine = options;
    fine.lattice_axes = options.lattice_axes * rotation * oblique();
    fine.lattice_origin.reset();
    const BodySpace turned(surface, fine);
    const FilledSites samples = samples_of(turned, fine, lattice.radius / finer);
    for_each_site(samples.runs, [&](std::size_t, const Run& run, int n) {
      const Vec3 point = turned.placement.from_lattice(samples.lattice.site(run.row, n));
      const Vec3 at =
          (space.placement.to_lattice(point) - lattice.origin).cwiseQuotient(lattice.unit);
      const std::int64_t found = owner(index, at);
      const auto site = static_cast<std::size_t>(found);
      if (found >= 0 && touching.neighbors[site] < neighbors_inside)
        sampled.add(site, at - Vec3(places[site][0], places[site][1], places[site][2]));
    });
  }
  double inside = 0, outside = 0;
  std::vector<double> share(sampled.count.size(), 1);
  for (std::size_t i = 0; i < share.size(); ++i) {
    const bool whole = touching.neighbors[i] == neighbors_inside;
    if (!whole) share[i] = sampled.share(i);
    (whole ? inside : outside) += share[i];
  }
  const double wanted = volume / volume_per_particle(lattice.radius) - inside;
  if (volume > 0 && wanted > outside / most_scaling && wanted < outside * most_scaling)
    for (std::size_t i = 0; i < share.size(); ++i)
      if (touching.neighbors[i] < neighbors_inside) share[i] *= wanted / outside;
  balance(filled, index, touching, sampled, share);
  return share;
}

}  // namespace sinew
