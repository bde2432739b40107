// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/physics/lists/verlet_lists.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/parallel.h>
#include <sinew/core/system.h>

namespace sinew {
namespace {

// In diameters, measured: longer lists cost every step, shorter ones are made more often. The
// narrow skin leaves out the second neighbours of a packed body.
constexpr double wide_skin = 0.9, narrow_skin = 0.1;
// Particles that moved farther than the others are astray: farther than the first of these, in
// diameters, that only one block in so many exceeds, or than the last. If more than one particle in
// so many is, all lists are made anew.
constexpr std::array astray{0.04, 0.07, 0.1, 0.15, 0.2};
constexpr std::size_t blocks_per_stray = 100, particles_per_stray = 50;
constexpr std::size_t blocks_per_piece = kernel::blocks_per_piece;
constexpr std::size_t pieces_per_part = 32;
constexpr std::size_t strays_per_piece = 8;

template <class Real>
kernel::Ride<Real> ride_of(const Riders<Real>& riders,
                           std::array<std::vector<float>, 3>& reference) {
  return {riders.state.arrays(),
          riders.carriers,
          {reference[0].data(), reference[1].data(), reference[2].data()}};
}

/// Calls visit(begin, end) for parts of the blocks.
template <class Visit>
void for_each_part(std::size_t blocks, Visit&& visit) {
  parallel_for(blocks, blocks_per_piece * pieces_per_part, visit);
}

}  // namespace

template <class Real>
PartnerLists<Real>::PartnerLists(const kernel::Functions<Real>& kernel, const PairForce& pair,
                                 double step)
    : kernel_(kernel), pair_(pair), step_(step) {}

/// In lengths of the kernel.
template <class Real>
double PartnerLists<Real>::range(double skin, const Measure& measure) const {
  return (pair_.b + skin * 2 * pair_.r) / measure.length;
}

template <class Real>
OffsetLists PartnerLists<Real>::wide_of(BlockState<Real>& state, const Measure& measure) const {
  const double reach = range(wide_skin, measure);
  return find_offsets(kernel_, state, BlockCells(state, reach), reach);
}

template <class Real>
void PartnerLists<Real>::make(const Riders<Real>& riders) {
  Stopwatch watch;
  ++counts_.rebuilds;
  const double reach = range(wide_skin, riders.measure);
  cells_ = BlockCells(riders.state, reach);
  wide_ = find_offsets(kernel_, riders.state, cells_, reach);
  contacts_ = Contacts(riders.state, riders.measure, riders.carrier, riders.pose.size() + 1,
                       reach * riders.measure.length);
  for (auto& axis : reference_) axis.resize(riders.state.blocks() * BlockState<Real>::block);
  const auto ride = ride_of(riders, reference_);
  for_each_part(riders.state.blocks(),
                [&](std::size_t begin, std::size_t end) { kernel_.remember(ride, begin, end); });
  cells_.forget_particles();
  listed_pose_ = last_pose_ = riders.pose;
  wide_drift_ = Drift(wide_skin * 2 * pair_.r);
  strayed_.clear();
  shift_ = 0;
  counts_.rebuilding += watch.lap();
  sift(riders);
}

template <class Real>
void PartnerLists<Real>::sift(const Riders<Real>& riders) {
  Stopwatch watch;
  ++counts_.sifts;
  narrow_ = sift_offsets(kernel_, riders.state, wide_, range(narrow_skin, riders.measure));
  narrow_drift_ = Drift(narrow_skin * 2 * pair_.r);
  sifted_motions_ = motions_between(listed_pose_, riders.pose);
  moved_when_sifted_ = wide_drift_.moved();
  counts_.sifting += watch.lap();
}

/// How far the particles may have moved in their frames in the step that led here.
template <class Real>
void PartnerLists<Real>::add_step(const Pose& pose, double fastest, double rounding) {
  double excess = 0;
  for (std::size_t b = 0; b < pose.size(); ++b) {
    const double reach =
        contacts_.reach_from(listed_pose_[b].frame.origin, b) + wide_drift_.skin() + shift_;
    excess = std::max(excess, excess_of_step(last_pose_[b], pose[b], step_, reach));
  }
  const double moved = fastest * step_ * (1 + 1e-5) + rounding + excess;
  wide_drift_.add(moved);
  narrow_drift_.add(moved);
  last_pose_ = pose;
}

template <class Real>
bool PartnerLists<Real>::follow(const Riders<Real>& riders, double fastest) {
  // Whole units of single precision add up to one unit to what the speed says.
  add_step(riders.pose, fastest, sizeof(Real) == 4 && fastest > 0 ? riders.measure.length : 0);
  const auto motions = motions_between(listed_pose_, riders.pose);
  const double approach = contacts_.approach(motions, shift_);
  if (!wide_drift_.holds(approach)) {
    if (!look(riders)) return false;
    sift(riders);
  }
  const double since =
      contacts_.approach_since(sifted_motions_, motions, moved_when_sifted_, shift_);
  if (!narrow_drift_.holds(since)) sift(riders);
  return true;
}

/// The place of a particle in the frame of its carrier, in lengths.
template <class Real>
Vec3 PartnerLists<Real>::place(const Riders<Real>& riders, std::size_t k) const {
  const auto& frame = riders.carriers.frames[riders.carrier[k]];
  const auto arrays = riders.state.arrays();
  Vec3 arm;
  Mat3 axes;
  for (int axis = 0; axis < 3; ++axis) {
    arm[axis] = static_cast<double>(difference_of(arrays.x[axis][k], frame.centre[axis])) -
                static_cast<double>(frame.rest_of_centre[axis]);
    for (int column = 0; column < 3; ++column)
      axes(axis, column) = static_cast<double>(frame.axes[3 * axis + column]);
  }
  return axes * arm;
}

/// The largest displacement within each block since the lists were made, in lengths.
template <class Real>
std::vector<double> PartnerLists<Real>::displacements(const Riders<Real>& riders) {
  std::vector<double> largest(riders.state.blocks());
  const auto ride = ride_of(riders, reference_);
  for_each_part(largest.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t block = begin; block < end; ++block)
      largest[block] = std::sqrt(static_cast<double>(kernel_.displacement(ride, block, block + 1)));
  });
  return largest;
}

/// Beyond what displacement, m, particles of blocks so displaced are astray.
template <class Real>
double PartnerLists<Real>::astray_beyond(const std::vector<double>& displaced,
                                         const Measure& measure) const {
  for (const double diameters : astray) {
    const double limit = diameters * 2 * pair_.r, lengths = 0.999 * limit / measure.length;
    const auto beyond = std::count_if(displaced.begin(), displaced.end(),
                                      [&](double most) { return most >= lengths; });
    if (static_cast<std::size_t>(beyond) * blocks_per_stray <= displaced.size()) return limit;
  }
  return astray.back() * 2 * pair_.r;
}

/// The particles displaced by `limit` (m) or more, ascending.
template <class Real>
std::vector<std::uint32_t> PartnerLists<Real>::strays(const Riders<Real>& riders,
                                                      const std::vector<double>& displaced,
                                                      double limit) {
  const double lengths = 0.999 * limit / riders.measure.length;
  constexpr std::size_t size = BlockState<Real>::block;
  std::vector<std::uint32_t> found;
  for (std::size_t block = 0; block < displaced.size(); ++block) {
    if (displaced[block] < lengths) continue;
    for (std::size_t k = block * size; k < std::min((block + 1) * size, riders.carrier.size());
         ++k) {
      const Vec3 was(reference_[0][k], reference_[1][k], reference_[2][k]);
      if ((place(riders, k) - was).norm() >= lengths)
        found.push_back(static_cast<std::uint32_t>(k));
    }
  }
  return found;
}

/// Gives strays new partners. False where there are too many, or too little is left to go on with.
template <class Real>
bool PartnerLists<Real>::look(const Riders<Real>& riders) {
  Stopwatch watch;
  ++counts_.looks;
  const auto displaced = displacements(riders);
  const double limit = astray_beyond(displaced, riders.measure);
  const auto found = strays(riders, displaced, limit);
  if (found.size() * particles_per_stray > riders.carrier.size()) return false;
  for (const std::uint32_t k : found) anchor(riders, k);
  // Of places widened by what the strays have moved, hence after that.
  const double approach = contacts_.approach(motions_between(listed_pose_, riders.pose), shift_);
  if (!found.empty()) wide_ = with_added(wide_, partners_of(riders, found, limit + approach));
  counts_.strays += static_cast<std::int64_t>(found.size());
  // References are kept in floats: to their rounding.
  double reach = 0;
  for (std::size_t b = 0; b < listed_pose_.size(); ++b)
    reach = std::max(reach, contacts_.reach_from(listed_pose_[b].frame.origin, b));
  wide_drift_.found(limit + 2.5e-7 * reach);
  counts_.looking += watch.lap();
  // Strays are found in the cells around their place; and no two of them may meet that were farther
  // apart, when the lists were made, than the bones' contacts know.
  const double edge = cells_.edge() * riders.measure.length;
  const double room = std::min(edge - approach - limit, edge / 2);
  return shift_ < room && wide_drift_.holds(approach + wide_drift_.skin() / 8);
}

/// Where the particle would have been when the lists were made, had it stood where it does in its
/// carrier's frame: m.
template <class Real>
Vec3 PartnerLists<Real>::place_when_listed(const Riders<Real>& riders, std::size_t k) const {
  const Vec3 here = riders.state.position(k, riders.measure);
  if (riders.carrier[k] >= riders.pose.size()) return here;
  const RigidFrame &now = riders.pose[riders.carrier[k]].frame,
                   &then = listed_pose_[riders.carrier[k]].frame;
  return then.origin + then.rotation * (now.rotation.transpose() * (here - now.origin));
}

/// The pairs of a stray with all that could come near it before the next look, when others may have
/// come nearer by `nearer` (m) than their references tell.
template <class Real>
void PartnerLists<Real>::pair_up(const Riders<Real>& riders, std::uint32_t k, double nearer,
                                 std::vector<BlockOffset>& added) const {
  const auto arrays = riders.state.arrays();
  const std::size_t size = BlockState<Real>::block;
  const double reach = range(wide_skin, riders.measure) + nearer / riders.measure.length;
  const Vec3 at = (place_when_listed(riders, k) - riders.measure.origin) / riders.measure.length;
  std::vector<std::uint32_t> blocks;
  cells_.for_each_block_near(at, [&](std::uint32_t block) { blocks.push_back(block); });
  std::sort(blocks.begin(), blocks.end());
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  const auto add = [&](std::uint32_t block, std::int64_t offset) {
    const BlockOffset one{block, static_cast<std::int32_t>(offset)};
    if (!wide_.has(one)) added.push_back(one);
  };
  for (const std::uint32_t block : blocks)
    for (std::size_t j = block * size; j < std::min((block + 1) * size, riders.carrier.size());
         ++j) {
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
std::vector<BlockOffset> PartnerLists<Real>::partners_of(const Riders<Real>& riders,
                                                         const std::vector<std::uint32_t>& found,
                                                         double nearer) const {
  std::vector<std::vector<BlockOffset>> parts(found.size() / strays_per_piece + 1);
  parallel_for(found.size(), strays_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n)
      pair_up(riders, found[n], nearer, parts[begin / strays_per_piece]);
  });
  std::vector<BlockOffset> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// Takes the particle's place as the one to measure from.
template <class Real>
void PartnerLists<Real>::anchor(const Riders<Real>& riders, std::uint32_t k) {
  const Vec3 now = place(riders, k);
  const Vec3 was(reference_[0][k], reference_[1][k], reference_[2][k]);
  const Vec3 first = strayed_.try_emplace(k, was).first->second;
  shift_ = std::max(shift_, (now - first).norm() * riders.measure.length);
  for (int axis = 0; axis < 3; ++axis) reference_[axis][k] = static_cast<float>(now[axis]);
}

template <class Real>
ListCounts PartnerLists<Real>::counts() const {
  ListCounts counts = counts_;
  counts.wide = wide_.mean();
  counts.narrow = narrow_.mean();
  return counts;
}

template class PartnerLists<double>;
template class PartnerLists<float>;

}  // namespace sinew
