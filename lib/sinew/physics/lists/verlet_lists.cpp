// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/physics/lists/verlet_lists.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/parallel.h>
#include <sinew/core/system.h>

namespace sinew {
namespace {

// In diameters, by measurement: longer lists cost every step, shorter ones are rebuilt more often.
// The inner skin excludes the second neighbors of a packed body.
constexpr double outer_skin = 0.9, inner_skin = 0.1;
// Particles displaced more than the others have escaped: beyond the first of these distances, in
// diameters, that only one block in so many exceeds, or beyond the last. If more than one particle
// in so many has, all lists are rebuilt.
constexpr std::array escape_distances{0.04, 0.07, 0.1, 0.15, 0.2};
constexpr std::size_t blocks_per_escaped = 100, particles_per_escaped = 50;
constexpr std::size_t blocks_per_piece = kernel::blocks_per_piece;
constexpr std::size_t pieces_per_part = 32;
constexpr std::size_t escaped_per_piece = 8;

template <class Real>
kernel::FrameDrift<Real> frame_drift_of(const MovingParticles<Real>& particles,
                                        std::array<std::vector<float>, 3>& reference) {
  return {particles.state.arrays(),
          particles.comoving_frames,
          {reference[0].data(), reference[1].data(), reference[2].data()}};
}

/// Calls visit(begin, end) for parts of the blocks.
template <class Visit>
void for_each_part(std::size_t blocks, Visit&& visit) {
  parallel_for(blocks, blocks_per_piece * pieces_per_part, visit);
}

}  // namespace

template <class Real>
VerletLists<Real>::VerletLists(const kernel::Functions<Real>& kernel, const PairForce& pair,
                               double step)
    : kernel_(kernel), pair_(pair), step_(step) {}

/// In lengths of the kernel.
template <class Real>
double VerletLists<Real>::range(double skin, const Units& units) const {
  return (pair_.b + skin * 2 * pair_.r) / units.length;
}

template <class Real>
OffsetLists VerletLists<Real>::outer_of(BlockState<Real>& state, const Units& units) const {
  const double reach = range(outer_skin, units);
  return find_offsets(kernel_, state, BlockCells(state, reach), reach);
}

template <class Real>
void VerletLists<Real>::make(const MovingParticles<Real>& particles) {
  Stopwatch watch;
  ++counts_.rebuilds;
  const double reach = range(outer_skin, particles.units);
  cells_ = BlockCells(particles.state, reach);
  outer_ = find_offsets(kernel_, particles.state, cells_, reach);
  contacts_ = Contacts(particles.state, particles.units, particles.comoving_frame,
                       particles.pose.size() + 1, reach * particles.units.length);
  for (auto& axis : reference_) axis.resize(particles.state.blocks() * BlockState<Real>::block);
  const auto drift = frame_drift_of(particles, reference_);
  for_each_part(particles.state.blocks(),
                [&](std::size_t begin, std::size_t end) { kernel_.remember(drift, begin, end); });
  cells_.forget_particles();
  listed_pose_ = last_pose_ = particles.pose;
  outer_drift_ = Drift(outer_skin * 2 * pair_.r);
  escaped_.clear();
  shift_ = 0;
  counts_.rebuilding += watch.lap();
  prune(particles);
}

template <class Real>
void VerletLists<Real>::prune(const MovingParticles<Real>& particles) {
  Stopwatch watch;
  ++counts_.prunings;
  inner_ = prune_offsets(kernel_, particles.state, outer_, range(inner_skin, particles.units));
  inner_drift_ = Drift(inner_skin * 2 * pair_.r);
  pruned_motions_ = motions_between(listed_pose_, particles.pose);
  moved_when_pruned_ = outer_drift_.moved();
  counts_.pruning += watch.lap();
}

/// Bounds the displacements in the co-moving frames in the last step.
template <class Real>
void VerletLists<Real>::add_step(const Pose& pose, double fastest, double rounding) {
  double excess = 0;
  for (std::size_t b = 0; b < pose.size(); ++b) {
    const double reach =
        contacts_.reach_from(listed_pose_[b].frame.origin, b) + outer_drift_.skin() + shift_;
    excess = std::max(excess, excess_of_step(last_pose_[b], pose[b], step_, reach));
  }
  const double moved = fastest * step_ * (1 + 1e-5) + rounding + excess;
  outer_drift_.add(moved);
  inner_drift_.add(moved);
  last_pose_ = pose;
}

template <class Real>
bool VerletLists<Real>::follow(const MovingParticles<Real>& particles, double fastest) {
  // Fixed-point rounding adds up to one unit to the distance that the speed gives.
  add_step(particles.pose, fastest, sizeof(Real) == 4 && fastest > 0 ? particles.units.length : 0);
  const auto motions = motions_between(listed_pose_, particles.pose);
  const double approach = contacts_.approach(motions, shift_);
  if (!outer_drift_.holds(approach)) {
    if (!check_displacements(particles)) return false;
    prune(particles);
  }
  const double since =
      contacts_.approach_since(pruned_motions_, motions, moved_when_pruned_, shift_);
  if (!inner_drift_.holds(since)) prune(particles);
  return true;
}

/// Coordinates of a particle in its co-moving frame, in lengths of the kernel.
template <class Real>
Vec3 VerletLists<Real>::place(const MovingParticles<Real>& particles, std::size_t k) const {
  const auto& frame = particles.comoving_frames.frames[particles.comoving_frame[k]];
  const auto arrays = particles.state.arrays();
  Vec3 arm;
  Mat3 axes;
  for (int axis = 0; axis < 3; ++axis) {
    arm[axis] = static_cast<double>(difference_of(arrays.x[axis][k], frame.center[axis])) -
                static_cast<double>(frame.rest_of_center[axis]);
    for (int column = 0; column < 3; ++column)
      axes(axis, column) = static_cast<double>(frame.axes[3 * axis + column]);
  }
  return axes * arm;
}

/// The largest displacement in each block since the lists were built, in lengths of the kernel.
template <class Real>
std::vector<double> VerletLists<Real>::displacements(const MovingParticles<Real>& particles) {
  std::vector<double> largest(particles.state.blocks());
  const auto drift = frame_drift_of(particles, reference_);
  for_each_part(largest.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t block = begin; block < end; ++block)
      largest[block] =
          std::sqrt(static_cast<double>(kernel_.displacement(drift, block, block + 1)));
  });
  return largest;
}

/// The displacement, m, beyond which particles have escaped.
template <class Real>
double VerletLists<Real>::escaped_beyond(const std::vector<double>& displaced,
                                         const Units& units) const {
  for (const double diameters : escape_distances) {
    const double limit = diameters * 2 * pair_.r, lengths = 0.999 * limit / units.length;
    const auto beyond = std::count_if(displaced.begin(), displaced.end(),
                                      [&](double most) { return most >= lengths; });
    if (static_cast<std::size_t>(beyond) * blocks_per_escaped <= displaced.size()) return limit;
  }
  return escape_distances.back() * 2 * pair_.r;
}

/// The particles displaced by `limit` (m) or more, ascending.
template <class Real>
std::vector<std::uint32_t> VerletLists<Real>::escaped_particles(
    const MovingParticles<Real>& particles, const std::vector<double>& displaced, double limit) {
  const double lengths = 0.999 * limit / particles.units.length;
  constexpr std::size_t size = BlockState<Real>::block;
  std::vector<std::uint32_t> found;
  for (std::size_t block = 0; block < displaced.size(); ++block) {
    if (displaced[block] < lengths) continue;
    for (std::size_t k = block * size;
         k < std::min((block + 1) * size, particles.comoving_frame.size()); ++k) {
      const Vec3 was(reference_[0][k], reference_[1][k], reference_[2][k]);
      if ((place(particles, k) - was).norm() >= lengths)
        found.push_back(static_cast<std::uint32_t>(k));
    }
  }
  return found;
}

/// Finds new neighbors for escaped particles. False where there are too many, or too little of the
/// skin is left.
template <class Real>
bool VerletLists<Real>::check_displacements(const MovingParticles<Real>& particles) {
  Stopwatch watch;
  ++counts_.checks;
  const auto displaced = displacements(particles);
  const double limit = escaped_beyond(displaced, particles.units);
  const auto found = escaped_particles(particles, displaced, limit);
  if (found.size() * particles_per_escaped > particles.comoving_frame.size()) return false;
  for (const std::uint32_t k : found) anchor(particles, k);
  // After anchor(): these references have moved.
  const double approach = contacts_.approach(motions_between(listed_pose_, particles.pose), shift_);
  if (!found.empty()) outer_ = with_added(outer_, neighbors_of(particles, found, limit + approach));
  counts_.escaped += static_cast<std::int64_t>(found.size());
  // References are floats: to their rounding.
  double reach = 0;
  for (std::size_t b = 0; b < listed_pose_.size(); ++b)
    reach = std::max(reach, contacts_.reach_from(listed_pose_[b].frame.origin, b));
  outer_drift_.reset(limit + 2.5e-7 * reach);
  counts_.checking += watch.lap();
  // Escaped particles are searched for in the cells around their place; and no two of them may meet
  // that were farther apart, when the lists were built, than the contacts account for.
  const double edge = cells_.edge() * particles.units.length;
  const double room = std::min(edge - approach - limit, edge / 2);
  return shift_ < room && outer_drift_.holds(approach + outer_drift_.skin() / 8);
}

/// Where the particle would have been when the lists were built, at its present place in its
/// co-moving frame, m.
template <class Real>
Vec3 VerletLists<Real>::place_when_listed(const MovingParticles<Real>& particles,
                                          std::size_t k) const {
  const Vec3 here = particles.state.position(k, particles.units);
  if (particles.comoving_frame[k] >= particles.pose.size()) return here;
  const RigidFrame &now = particles.pose[particles.comoving_frame[k]].frame,
                   &then = listed_pose_[particles.comoving_frame[k]].frame;
  return then.origin + then.rotation * (now.rotation.transpose() * (here - now.origin));
}

/// The pairs of an escaped particle with all that could come near it before the next check, when
/// others may be nearer by `nearer` (m) than their references indicate.
template <class Real>
void VerletLists<Real>::add_pairs(const MovingParticles<Real>& particles, std::uint32_t k,
                                  double nearer, std::vector<BlockOffset>& added) const {
  const auto arrays = particles.state.arrays();
  const std::size_t size = BlockState<Real>::block;
  const double reach = range(outer_skin, particles.units) + nearer / particles.units.length;
  const Vec3 at =
      (place_when_listed(particles, k) - particles.units.origin) / particles.units.length;
  std::vector<std::uint32_t> blocks;
  cells_.for_each_block_near(at, [&](std::uint32_t block) { blocks.push_back(block); });
  std::sort(blocks.begin(), blocks.end());
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  const auto add = [&](std::uint32_t block, std::int64_t offset) {
    const BlockOffset one{block, static_cast<std::int32_t>(offset)};
    if (!outer_.has(one)) added.push_back(one);
  };
  for (const std::uint32_t block : blocks)
    for (std::size_t j = block * size;
         j < std::min((block + 1) * size, particles.comoving_frame.size()); ++j) {
      double squared = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const auto apart = static_cast<double>(difference_of(arrays.x[axis][k], arrays.x[axis][j]));
        squared += apart * apart;
      }
      if (squared >= reach * reach || j == k) continue;
      const std::int64_t offset = static_cast<std::int64_t>(j) - k;
      add(static_cast<std::uint32_t>(k / size), offset);
      add(block, -offset);
    }
}

template <class Real>
std::vector<BlockOffset> VerletLists<Real>::neighbors_of(const MovingParticles<Real>& particles,
                                                         const std::vector<std::uint32_t>& found,
                                                         double nearer) const {
  std::vector<std::vector<BlockOffset>> parts(found.size() / escaped_per_piece + 1);
  parallel_for(found.size(), escaped_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n)
      add_pairs(particles, found[n], nearer, parts[begin / escaped_per_piece]);
  });
  std::vector<BlockOffset> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// Makes the particle's present place its reference.
template <class Real>
void VerletLists<Real>::anchor(const MovingParticles<Real>& particles, std::uint32_t k) {
  const Vec3 now = place(particles, k);
  const Vec3 was(reference_[0][k], reference_[1][k], reference_[2][k]);
  const Vec3 first = escaped_.try_emplace(k, was).first->second;
  shift_ = std::max(shift_, (now - first).norm() * particles.units.length);
  for (int axis = 0; axis < 3; ++axis) reference_[axis][k] = static_cast<float>(now[axis]);
}

template <class Real>
ListCounts VerletLists<Real>::counts() const {
  ListCounts counts = counts_;
  counts.outer = outer_.mean();
  counts.inner = inner_.mean();
  return counts;
}

template class VerletLists<double>;
template class VerletLists<float>;

}  // namespace sinew
