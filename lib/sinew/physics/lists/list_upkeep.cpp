// SPDX-License-Identifier: GPL-3.0-or-later
// When neighbor lists are rebuilt, and particles sorted and units chosen for them.
#include <algorithm>
#include <utility>

#include <sinew/core/parallel.h>
#include <sinew/core/system.h>
#include <sinew/physics/lists/list_stepper.h>
#include <sinew/physics/lists/offset_lists.h>

namespace sinew {
namespace {

// Columns of sorted particles, in diameters; how much lists may grow before sorting is tried again.
constexpr double column_edge = 1.2, most_growth = 1.3;
// The last bits of sums depend on the order of the particles. When that order is checked follows
// from the step count alone, so that a resumed run sorts when an uninterrupted one does. The lists
// built for the check cost about one step in a hundred.
constexpr std::int64_t steps_between_order_checks = 1024;

template <class Real>
Box box_of(const BlockState<Real>& state, const Units& units, std::size_t grain) {
  std::vector<Box> boxes(state.size() / grain + 1);
  parallel_for(state.size(), grain, [&](std::size_t begin, std::size_t end) {
    Box& box = boxes[begin / grain];
    for (std::size_t k = begin; k < end; ++k) box.extend(state.position(k, units));
  });
  Box all;
  for (const Box& box : boxes)
    if (!box.isEmpty()) all.extend(box);
  return all;
}

}  // namespace

template <class Real>
void ListStepper<Real>::choose_comoving_frames(const Pose& pose) {
  comoving_frames_.choose(*body_, pose, state_, units_, {id_.data() + block, caller_.size()});
  frame_slots_ = frame_slots<Real>(comoving_frames_.of_particles());
  place_comoving_frames(pose);
}

template <class Real>
void ListStepper<Real>::update_lists(const Pose& pose) {
  const std::optional<double> fastest = std::exchange(fastest_, std::nullopt);
  const bool anew = change_units();
  if (order_check_due()) {
    rebuild(pose);
    if (lists_.mean_of_outer() > most_growth * mean_when_sorted_ && sort()) rebuild(pose);
    return;
  }
  if (anew || !lists_.made()) return rebuild(pose);
  place_comoving_frames(pose);
  if (fastest && !lists_.follow(particles(), *fastest)) rebuild(pose);
}

/// A second check before the same step, as in a run resumed there, would change nothing.
template <class Real>
bool ListStepper<Real>::order_check_due() {
  return steps_ % steps_between_order_checks == 0 &&
         std::exchange(order_checked_, steps_) != steps_;
}

/// Sorts the particles into columns where that makes the lists shorter.
template <class Real>
bool ListStepper<Real>::sort() {
  Stopwatch watch;
  const auto order =
      order_by_columns(state_, column_edge * 2 * body_->material.pair.r / units_.length);
  reorder(state_, order, next_);
  const double sorted = lists_.outer_of(next_, units_).mean(), unsorted = lists_.mean_of_outer();
  mean_when_sorted_ = std::min(sorted, unsorted);
  sorting_ += watch.lap();
  if (sorted > 0.95 * unsorted) return false;
  ++sorts_;
  std::swap(state_, next_);
  std::vector<std::int32_t> id(id_.size(), 0);
  std::vector<std::uint32_t> caller(caller_.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    id[k + block] = id_[order[k] + block];
    caller[k] = caller_[order[k]];
  }
  id_ = std::move(id);
  caller_ = std::move(caller);
  find_slots();
  sorting_ += watch.lap();
  return true;
}

/// Chooses other units where the body may have left the range of the present ones, and has. When
/// that is checked follows from the bones' motion alone: lists differ in a resumed run.
template <class Real>
bool ListStepper<Real>::change_units() {
  if (sizeof(Real) == 8 || traveled_ <= free_travel<Real>(units_)) return false;
  const std::size_t n = caller_.size();
  units_box_ = box_of(state_, units_, particles_per_thread);
  traveled_ = 0;
  if (sinew::covers<Real>(units_, units_box_)) return false;
  const Units before =
      std::exchange(units_, units_for<Real>(units_box_, body_->material.pair, stepping_.step));
  parallel_split(n, particles_per_thread, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      state_.set_velocity(k, state_.velocity(k, before), units_);
      state_.set_position(k, state_.position(k, before), units_);
    }
  });
  find_slots();
  return true;
}

/// How far a particle may travel in a valid step: with its bone, and relative to it.
template <class Real>
double ListStepper<Real>::travel_of_step(const Pose& pose) const {
  double fastest = 0;
  for (const BonePose& bone : pose) {
    const double spread = bone.angular_velocity.norm() * traveled_;
    for (int corner = 0; corner < 8 && !units_box_.isEmpty(); ++corner) {
      const Vec3 at = units_box_.corner(static_cast<Box::CornerType>(corner));
      fastest = std::max(fastest, bone.velocity_at(at).norm() + spread);
    }
  }
  return 1.001 * (fastest * stepping_.step + most_radii_per_step * body_->material.pair.r);
}

template <class Real>
void ListStepper<Real>::rebuild(const Pose& pose) {
  place_bones(pose);
  choose_comoving_frames(pose);
  lists_.make(particles());
}

template void ListStepper<double>::update_lists(const Pose& pose);
template void ListStepper<float>::update_lists(const Pose& pose);
template double ListStepper<double>::travel_of_step(const Pose& pose) const;
template double ListStepper<float>::travel_of_step(const Pose& pose) const;

}  // namespace sinew
