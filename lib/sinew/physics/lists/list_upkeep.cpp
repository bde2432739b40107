// SPDX-License-Identifier: GPL-3.0-or-later
// When the lists of partners are made anew, and the particles sorted and measured for them.
#include <algorithm>
#include <utility>

#include <sinew/core/parallel.h>
#include <sinew/core/system.h>
#include <sinew/physics/lists/list_stepper.h>
#include <sinew/physics/lists/offset_lists.h>

namespace sinew {
namespace {

// Columns of sorted particles, in diameters; how much longer lists may become before a sort is
// tried anew.
constexpr double column_edge = 1.2, most_growth = 1.3;
// When the order of the particles is looked at, which the last bits of sums depend on, follows from
// the count of steps alone, so that a run that is resumed sorts when an unbroken one does. The
// lists made for it cost about one step in a hundred.
constexpr std::int64_t steps_between_looks_at_order = 1024;

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
void ListStepper<Real>::keep_lists_true(const Pose& pose) {
  const std::optional<double> fastest = std::exchange(fastest_, std::nullopt);
  const bool anew = change_units();
  if (must_look_at_order()) {
    rebuild(pose);
    if (lists_.mean_of_outer() > most_growth * mean_when_sorted_ && sort()) rebuild(pose);
    return;
  }
  if (anew || !lists_.made()) return rebuild(pose);
  place_comoving_frames(pose);
  if (fastest && !lists_.follow(particles(), *fastest)) rebuild(pose);
}

/// A second look before the same step, as in a run resumed there, would change nothing.
template <class Real>
bool ListStepper<Real>::must_look_at_order() {
  return steps_ % steps_between_looks_at_order == 0 &&
         std::exchange(order_looked_at_, steps_) != steps_;
}

/// Puts the particles into columns where that makes the lists shorter.
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

/// Takes a new units where the body may have come to the end of the present one's range, and has.
/// When that is looked at follows from the bones' motion alone: lists differ in a run that is
/// resumed.
template <class Real>
bool ListStepper<Real>::change_units() {
  if (sizeof(Real) == 8 || traveled_ <= free_travel<Real>(units_)) return false;
  const std::size_t n = caller_.size();
  units_box_ = box_of(state_, units_, particles_per_thread);
  traveled_ = 0;
  if (sinew::serves<Real>(units_, units_box_)) return false;
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

/// How far a particle may come in a step that is sound: its bone's way and what it moves beside.
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

template void ListStepper<double>::keep_lists_true(const Pose& pose);
template void ListStepper<float>::keep_lists_true(const Pose& pose);
template double ListStepper<double>::travel_of_step(const Pose& pose) const;
template double ListStepper<float>::travel_of_step(const Pose& pose) const;

}  // namespace sinew
