// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/stepping/detail/rigid_references.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include <sinew/body/solid.h>
#include <sinew/core/decompositions.h>
#include <sinew/core/parallel.h>
#include <sinew/core/union_find.h>
#include <sinew/world/references.h>

namespace sinew {
namespace {

constexpr std::size_t block_of_sums = 2048, blocks_per_task = 4;
// The step count alone decides, so that a resumed run looks when an uninterrupted one does.
constexpr std::int64_t steps_between_looks = 64;
constexpr double no_inertia = 1e-12;  // fraction of the largest: as of particles in a row

template <class Real>
Vec3 place(const kernel::State<Real>& state, const Units& units, std::size_t k) {
  const auto coordinate = [&](int axis) { return static_cast<double>(state.x[axis][k]); };
  return units.origin + units.length * Vec3(coordinate(0), coordinate(1), coordinate(2));
}

}  // namespace

RigidReferences::RigidReferences(std::shared_ptr<const Body> body) : body_(std::move(body)) {
  set_damping(body_->rigid_damping);
}

void RigidReferences::set_damping(std::shared_ptr<const RigidDamping> damping) {
  damping_ = std::move(damping);
  alone_ = damping_ && damping_->shares.size() == body_->rest.size();
}

void RigidReferences::set_order(std::span<const std::int32_t> id) {
  if (!damping_) return;
  const RigidDamping& damping = *damping_;
  parts_.clear();
  part_.clear();
  id_.assign(id.begin(), id.end());
  const auto moves_itself = [](const Reference& one) { return one.kind == Reference::itself; };
  if (std::none_of(damping.references.begin(), damping.references.end(), moves_itself)) return;
  part_.assign(id.size(), none);
  mass_.clear();
  if (!body_->density.empty())
    for (const std::int32_t i : id)
      mass_.push_back(mass_of(*body_, static_cast<std::size_t>(i), 1));
  std::vector<std::uint32_t> part_of(damping.references.size(), none);
  std::vector<std::size_t> place_of(body_->rest.size());
  for (std::size_t k = 0; k < id.size(); ++k) {
    place_of[static_cast<std::size_t>(id[k])] = k;
    for (const Share& share : damping.of(static_cast<std::size_t>(id[k]))) {
      if (damping.references[share.reference].kind != Reference::itself) continue;
      std::uint32_t& part = part_of[share.reference];
      if (part == none) {
        part = static_cast<std::uint32_t>(parts_.size());
        parts_.push_back({share.reference, k, {}});
      }
      part_[k] = part;
    }
  }
  for (Part& part : parts_)
    for (const std::uint32_t pin : damping.references[part.reference].pins)
      part.pins.push_back(place_of[body_->world->pins[pin].particle]);
}

/// Sums over particles of one part. Holders' motions are taken off before.
template <class Real>
RigidReferences::Sums RigidReferences::sums_of(const kernel::State<Real>& state, const Units& units,
                                               const Vec3& about, std::size_t begin,
                                               std::size_t end) const {
  const auto function = [&]<class R>(const kernel::MomentaInput<R>& input) {
    Sums sums;
    kernel::functions_of<R>(instructions_).momenta(input, sums.data());
    return sums;
  };
  const double* mass = mass_.empty() ? nullptr : mass_.data();
  if (alone_) {
    const Vec3 shift = units.origin - about;
    return function(kernel::MomentaInput<Real>{state,
                                               begin,
                                               end,
                                               units.length,
                                               units.length / units.time,
                                               {shift[0], shift[1], shift[2]},
                                               mass});
  }
  const std::size_t count = end - begin;
  std::array<std::array<double, block_of_sums>, 6> rows;
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t k = begin + n;
    const Vec3 at = place(state, units, k);
    Vec3 v(static_cast<double>(state.v[0][k]), static_cast<double>(state.v[1][k]),
           static_cast<double>(state.v[2][k]));
    v *= units.length / units.time;
    for (const Share& share : damping_->of(static_cast<std::size_t>(id_[k])))
      if (share.reference != parts_[part_[k]].reference)
        v -= share.weight * motions_[share.reference].velocity_at(at);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      rows[axis][n] = at[static_cast<int>(axis)] - about[static_cast<int>(axis)];
      rows[3 + axis][n] = v[static_cast<int>(axis)];
    }
  }
  return function(kernel::MomentaInput<double>{{{rows[0].data(), rows[1].data(), rows[2].data()},
                                                {rows[3].data(), rows[4].data(), rows[5].data()}},
                                               0,
                                               count,
                                               1,
                                               1,
                                               {0, 0, 0},
                                               mass == nullptr ? nullptr : mass + begin});
}

/// The rigid motion, of those that the part is free to make, with its momenta.
AffineMotion RigidReferences::motion_of(const Part& part, const Sums& sums, const Vec3& about,
                                        std::span<const Vec3> pins) const {
  const double mass = sums[0];
  const Vec3 off = Vec3(sums[1], sums[2], sums[3]) / mass;  // offset of the center of mass
  const Vec3 p(sums[10], sums[11], sums[12]);
  Mat3 second;
  second << sums[4], sums[9], sums[8], sums[9], sums[5], sums[7], sums[8], sums[7], sums[6];
  second -= mass * off * off.transpose();
  const double arm = std::sqrt(std::max(second.trace() / mass, 1e-300));
  Eigen::Matrix<double, 6, 6> inertia = Eigen::Matrix<double, 6, 6>::Zero();
  inertia.topLeftCorner<3, 3>() = mass * Mat3::Identity();
  inertia.bottomRightCorner<3, 3>() = second.trace() * Mat3::Identity() - second;
  Eigen::Matrix<double, 6, 1> momenta;
  momenta << p, Vec3(sums[13], sums[14], sums[15]) - off.cross(p);
  const Vec3 center = about + off;
  const auto free =
      free_motions(damping_->references[part.reference], body_->world.get(), pins, center, arm);
  // Lengths in arms, so that displacements and rotations are alike.
  Eigen::Matrix<double, 6, 1> scale;
  scale << 1, 1, 1, 1 / arm, 1 / arm, 1 / arm;
  const Eigen::MatrixXd basis = scale.cwiseInverse().asDiagonal() * free;
  const auto [values, axes] = eigendecomposition(basis.transpose() * scale.asDiagonal() * inertia *
                                                 scale.asDiagonal() * basis);
  Eigen::VectorXd along = axes.transpose() * (basis.transpose() * scale.asDiagonal() * momenta);
  for (Eigen::Index k = 0; k < along.size(); ++k)
    along[k] = values[k] > no_inertia * mass ? along[k] / values[k] : 0;
  const Eigen::Matrix<double, 6, 1> motion = scale.asDiagonal() * basis * axes * along;
  return {center, motion.head<3>(), cross_matrix(motion.tail<3>())};
}

template <class Real>
void RigidReferences::find(const TimedPose& moment, const kernel::State<Real>& state,
                           const Units& units) {
  if (!damping_) return;
  motions_ = motions_of_holders(*damping_, *body_, moment.time, moment.pose);
  Points about;
  for (const Part& part : parts_) about.push_back(place(state, units, part.first));
  const std::size_t blocks = (part_.size() + block_of_sums - 1) / block_of_sums;
  std::vector<std::vector<Run>> runs(blocks);
  parallel_for(blocks, blocks_per_task, [&](std::size_t from, std::size_t to) {
    for (std::size_t block = from; block < to; ++block) {
      const std::size_t last = std::min((block + 1) * block_of_sums, part_.size());
      for (std::size_t k = block * block_of_sums, end = k; k < last; k = end) {
        while (end < last && part_[end] == part_[k]) ++end;
        if (part_[k] != none)
          runs[block].push_back({part_[k], sums_of(state, units, about[part_[k]], k, end)});
      }
    }
  });
  std::vector<Sums> sums(parts_.size(), Sums{});
  for (const auto& block : runs)  // in this order, whichever thread made them
    for (const Run& run : block)
      for (std::size_t n = 0; n < run.sums.size(); ++n) sums[run.part][n] += run.sums[n];
  for (std::size_t n = 0; n < parts_.size(); ++n) {
    Points pins;
    for (const std::size_t k : parts_[n].pins) pins.push_back(place(state, units, k));
    motions_[parts_[n].reference] = motion_of(parts_[n], sums[n], about[n], pins);
  }
}

template void RigidReferences::find(const TimedPose&, const kernel::State<double>&, const Units&);
template void RigidReferences::find(const TimedPose&, const kernel::State<float>&, const Units&);

bool RigidReferences::follow_cracks(std::int64_t steps, const Stepper& stepper) {
  if (!damping_ || steps % steps_between_looks != 0) return false;
  const std::vector<std::int32_t> broken = stepper.broken_bonds();
  const std::int64_t now = std::accumulate(broken.begin(), broken.end(), std::int64_t{0});
  if (now == broken_) return false;
  broken_ = now;
  if (!near_) near_ = neighbors_of(*body_);
  const NeighborLists &near = near_->nearest, second = {};
  BondRest rest(near, second);
  stepper.read(rest);
  const std::vector<double> length = rest.take();
  UnionFind sets(body_->rest.size());
  for (std::uint32_t i = 0; i < body_->rest.size(); ++i)
    for (std::uint32_t e = near.first[i]; e < near.first[i + 1]; ++e)
      if (length[e] > 0)
        sets.join(static_cast<std::int32_t>(i), static_cast<std::int32_t>(near.neighbor[e]));
  piece_.resize(body_->rest.size());
  for (std::size_t i = 0; i < piece_.size(); ++i)
    piece_[i] = static_cast<std::uint32_t>(sets.first_of(static_cast<std::int32_t>(i)));
  set_damping(std::make_shared<const RigidDamping>(cut(*body_->rigid_damping, *body_, piece_)));
  set_order(std::vector<std::int32_t>(id_));
  return true;
}

void RigidReferences::save(SimulationState& state) const {
  put_column(state, "pieces", "label", piece_);
  put_column(state, "pieces", "broken", std::vector{broken_});
}

void RigidReferences::restore(const SimulationState& state) {
  if (!damping_) return;
  auto label = column_of<std::uint32_t>(state, "pieces", "label");
  const auto broken = column_of<std::int64_t>(state, "pieces", "broken");
  if (!label.empty() && label.size() != body_->rest.size())
    throw not_a_state("it has pieces of " + std::to_string(label.size()) + " particles");
  piece_ = std::move(label);
  broken_ = broken.empty() ? 0 : broken.front();
  set_damping(piece_.empty() ? body_->rigid_damping
                             : std::make_shared<const RigidDamping>(
                                   cut(*body_->rigid_damping, *body_, piece_)));
}

}  // namespace sinew
