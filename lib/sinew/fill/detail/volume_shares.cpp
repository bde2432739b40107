// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/fill/detail/volume_shares.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <utility>

#include <sinew/core/particles.h>

namespace sinew {
namespace {

constexpr double finer = 1.5;  // radius of the particles over that of the samples
constexpr int rotations = 24;  // number of rotations of a cube
constexpr double samples_per_particle = rotations * finer * finer * finer;
constexpr double max_scaling = 1.25, min_volume_share = 0.2;

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
  double volume_share(std::size_t site) const {
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
void balance(const Owners& owners, const Sampled& sampled, std::vector<double>& volume_share) {
  const std::vector<double> before = volume_share;
  for (std::size_t i = 0; i < volume_share.size(); ++i) {
    if (owners.surrounded(i) || sampled.count[i] == 0) continue;
    const Vec3 moment = before[i] / sampled.volume_share(i) * sampled.moment(i);
    std::vector<std::pair<std::size_t, Vec3>> around;
    Mat3 spread = Mat3::Zero();
    owners.for_each_touching(i, [&](std::size_t j) {
      const Vec3 from = owners.place(i) - owners.place(j);
      around.emplace_back(j, from);
      spread += from * from.transpose();
    });
    if (spread.determinant() < 1) continue;  // a chain or a sheet has nothing behind
    const Vec3 by = spread.inverse() * moment;
    for (const auto& [j, from] : around) {
      const double moved = by.dot(from);
      volume_share[i] += moved;
      volume_share[j] -= moved;
    }
  }
  for (double& one : volume_share) one = std::max(one, min_volume_share);
}

}  // namespace

std::vector<double> volume_shares(const Surface& surface, const PackOptions& options,
                                  const BodySpace& space, const Lattice& lattice,
                                  const Owners& owners, double volume) {
  Sampled sampled(owners.size());
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
      const std::int64_t found = owners.nearest(at);
      const auto owner = static_cast<std::size_t>(found);
      if (found >= 0 && !owners.surrounded(owner)) sampled.add(owner, at - owners.place(owner));
    });
  }
  double inside = 0, outside = 0;
  std::vector<double> volume_share(sampled.count.size(), 1);
  for (std::size_t i = 0; i < volume_share.size(); ++i) {
    const bool whole = owners.surrounded(i);
    if (!whole) volume_share[i] = sampled.volume_share(i);
    (whole ? inside : outside) += volume_share[i];
  }
  const double wanted = volume / volume_per_particle(lattice.radius) - inside;
  if (volume > 0 && wanted > outside / max_scaling && wanted < outside * max_scaling)
    for (std::size_t i = 0; i < volume_share.size(); ++i)
      if (!owners.surrounded(i)) volume_share[i] *= wanted / outside;
  balance(owners, sampled, volume_share);
  return volume_share;
}

}  // namespace sinew
