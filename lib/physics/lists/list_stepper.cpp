// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/lists/list_stepper.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "physics/lists/order.h"
#include "physics/solid/solid.h"

namespace sinew {
namespace {

// Columns of sorted particles, in diameters; how much longer lists may become before a sort is
// tried anew.
constexpr double column_edge = 1.2, most_growth = 1.3;
// When the order of the particles is looked at, which the last bits of sums depend on, follows from
// the count of steps alone, so that a run that is resumed sorts when an unbroken one does. The
// lists made for it cost about one step in a hundred.
constexpr std::int64_t steps_between_looks_at_order = 1024;
// A barrier costs more than the work below this many particles per thread.
constexpr std::size_t particles_per_thread = 8192;

template <class Real>
constexpr std::size_t pieces_per_thread = particles_per_thread /
                                          (kernel::blocks_per_piece * BlockState<Real>::block);

template <class Real>
Box box_of(const BlockState<Real>& state, const Measure& measure) {
  std::vector<Box> boxes(state.size() / particles_per_thread + 1);
  parallel_for(state.size(), particles_per_thread, [&](std::size_t begin, std::size_t end) {
    Box& box = boxes[begin / particles_per_thread];
    for (std::size_t k = begin; k < end; ++k) box.extend(state.position(k, measure));
  });
  Box all;
  for (const Box& box : boxes)
    if (!box.isEmpty()) all.extend(box);
  return all;
}

}  // namespace

template <class Real>
bool ListStepper<Real>::serves(const Body& body) {
  return !body.world && !remembers_neighbours(body.material) &&
         body.material.damping_form == DampingForm::paper &&
         std::all_of(body.springs.begin(), body.springs.end(), [](const BoneSprings& bone) {
           return bone.form == BoneForce::paper && bone.twist_form == TwistForm::servo;
         });
}

template <class Real>
ListStepper<Real>::ListStepper(std::shared_ptr<const Body> body, const Stepping& stepping,
                               const Particles& particles, kernel::InstructionSet instructions)
    : body_(std::move(body)),
      stepping_(stepping),
      mass_(particles.mass),
      kernel_(kernel::functions_of<Real>(instructions)),
      carriers_(*body_),
      lists_(kernel_, body_->material.pair, stepping.step) {
  load(particles);
}

template <class Real>
void ListStepper<Real>::load(const Particles& particles) {
  const std::size_t n = particles.size();
  Box box;
  for (std::size_t i = 0; i < n; ++i) box.extend(particles.position(i));
  measured_box_ = box;
  measure_ = measure_for<Real>(box, body_->material.pair, stepping_.step);
  state_ = next_ = BlockState<Real>(n);
  id_.assign((state_.blocks() + 2) * block, 0);
  caller_.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    caller_[k] = static_cast<std::uint32_t>(k);
    id_[k + block] = particles.id[k];
    state_.set_position(k, particles.position(k), measure_);
    state_.set_velocity(k, particles.velocity(k), measure_);
  }
  find_slots();
  totals_.resize((state_.blocks() + kernel::blocks_per_piece - 1) / kernel::blocks_per_piece);
}

template <class Real>
void ListStepper<Real>::find_slots() {
  slots_ = bone_slots<Real>(*body_, {id_.data() + block, caller_.size()}, measure_);
}

template <class Real>
void ListStepper<Real>::place_bones(const Pose& pose) {
  bones_ = bones_now<Real>(*body_, pose, slots_.centre, mass_, measure_);
}

template <class Real>
kernel::Holds<Real> ListStepper<Real>::holds() const {
  return {slots_.first.data(), slots_.slots.data(), slots_.held.data(), slots_.shares.data(),
          bones_.data()};
}

template <class Real>
kernel::Carriers<Real> ListStepper<Real>::carriers() const {
  return {carrier_slots_.first.data(), carrier_slots_.slots.data(), carrier_slots_.lanes.data(),
          frames_.data()};
}

template <class Real>
void ListStepper<Real>::place_carriers(const Pose& pose) {
  carrier_pose_ = carriers_.at(pose);
  frames_.clear();
  for (std::size_t c = 0; c < carrier_pose_.size(); ++c)
    frames_.push_back(c < bones_.size() ? bones_[c].frame
                                        : frame_now<Real>(carrier_pose_[c],
                                                          carrier_pose_[c].frame.origin, measure_));
  frames_.push_back(frame_now<Real>(BonePose(), measure_.origin, measure_));
}

template <class Real>
void ListStepper<Real>::choose_carriers(const Pose& pose) {
  carriers_.choose(*body_, pose, state_, measure_, {id_.data() + block, caller_.size()});
  carrier_slots_ = carrier_slots<Real>(carriers_.of_particles());
  place_carriers(pose);
}

template <class Real>
kernel::Step<Real> ListStepper<Real>::job() {
  const Material& material = body_->material;
  const PairForce& pair = material.pair;
  const double L = measure_.length, T = measure_.time, dt = stepping_.step;
  const auto real = [](double value) { return static_cast<Real>(value); };
  kernel::Step<Real> step{};
  step.before = state_.arrays();
  step.after = next_.arrays();
  step.blocks = state_.blocks();
  step.id = id_.data() + block;
  step.lists = lists_.arrays();
  step.holds = holds();
  step.carriers = carriers();
  const double per_mass = pair.r * T * T / mass_;
  step.law = {real(pair.r / L),
              real(pair.a / L),
              real(pair.b / L),
              real(pair.b / L * pair.b / L),
              real(pair.k1 * per_mass),
              real(pair.k2 * per_mass),
              real(material.damping * T / mass_)};
  for (int axis = 0; axis < 3; ++axis)
    step.gravity[axis] = real(measure_.acceleration(stepping_.gravity[axis]));
  const bool first_of_verlet = stepping_.integrator == Integrator::velocity_verlet && !kicked_;
  step.kick = real(dt / T * (first_of_verlet ? 0.5 : 1));
  step.drift = real(dt / T);
  step.middle = real(dt / T / 2);
  step.drift_first = stepping_.integrator == Integrator::explicit_euler;
  const double most = measure_.velocity(most_radii_per_step * pair.r / dt);
  step.most = real(most * most);
  step.totals = totals_.data();
  return step;
}

template <class Real>
Riders<Real> ListStepper<Real>::riders() {
  return {state_, measure_, carriers(), carriers_.of_particles(), carrier_pose_};
}

template <class Real>
void ListStepper<Real>::keep_lists_true(const Pose& pose) {
  const std::optional<double> fastest = std::exchange(fastest_, std::nullopt);
  const bool anew = remeasure();
  if (must_look_at_order()) {
    rebuild(pose);
    if (lists_.mean_of_wide() > most_growth * mean_when_sorted_ && sort()) rebuild(pose);
    return;
  }
  if (anew || !lists_.made()) return rebuild(pose);
  place_carriers(pose);
  if (fastest && !lists_.follow(riders(), *fastest)) rebuild(pose);
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
      order_by_columns(state_, column_edge * 2 * body_->material.pair.r / measure_.length);
  reorder(state_, order, next_);
  const double sorted = lists_.wide_of(next_, measure_).mean(), unsorted = lists_.mean_of_wide();
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

/// Takes a new measure where the body may have come to the end of the present one's range, and has.
/// When that is looked at follows from the bones' motion alone: lists differ in a run that is
/// resumed.
template <class Real>
bool ListStepper<Real>::remeasure() {
  if (sizeof(Real) == 8 || travelled_ <= free_travel<Real>(measure_)) return false;
  const std::size_t n = caller_.size();
  measured_box_ = box_of(state_, measure_);
  travelled_ = 0;
  if (sinew::serves<Real>(measure_, measured_box_)) return false;
  const Measure before = std::exchange(
      measure_, measure_for<Real>(measured_box_, body_->material.pair, stepping_.step));
  parallel_split(n, particles_per_thread, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      state_.set_velocity(k, state_.velocity(k, before), measure_);
      state_.set_position(k, state_.position(k, before), measure_);
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
    const double spread = bone.angular_velocity.norm() * travelled_;
    for (int corner = 0; corner < 8 && !measured_box_.isEmpty(); ++corner) {
      const Vec3 at = measured_box_.corner(static_cast<Box::CornerType>(corner));
      fastest = std::max(fastest, bone.velocity_at(at).norm() + spread);
    }
  }
  return 1.001 * (fastest * stepping_.step + most_radii_per_step * body_->material.pair.r);
}

template <class Real>
void ListStepper<Real>::rebuild(const Pose& pose) {
  place_bones(pose);
  choose_carriers(pose);
  lists_.make(riders());
}

template <class Real>
ListCounts ListStepper<Real>::counts() const {
  ListCounts counts = lists_.counts();
  counts.sorts = sorts_;
  counts.sorting = sorting_;
  return counts;
}

template <class Real>
StepSums ListStepper<Real>::sums_of_totals() const {
  // Per unit of mass and in the kernel's measure: to watts.
  const double watts =
      mass_ * measure_.length * measure_.length / (measure_.time * measure_.time * measure_.time);
  StepSums sums;
  for (const kernel::Totals& piece : totals_)  // in the order of the pieces, whoever made them
    sums.power += piece.power, sums.lost += piece.lost;
  sums.power *= watts;
  sums.lost *= watts;
  return sums;
}

template <class Real>
StepSums ListStepper<Real>::step(const Pose& pose) {
  place_bones(pose);
  keep_lists_true(pose);
  const auto now = job();
  parallel_split(totals_.size(), pieces_per_thread<Real>,
                 [&](std::size_t begin, std::size_t end) { kernel_.step(now, begin, end); });
  StepSums sums = sums_of_totals();
  double fastest = 0;
  bool sound = true;
  for (const kernel::Totals& piece : totals_)
    fastest = std::max(fastest, piece.fastest), sound = sound && piece.sound;
  if (!sound) {
    sums.failure = failure(pose);
    return sums;
  }
  fastest_ = std::sqrt(fastest) * measure_.length / measure_.time;
  std::swap(state_, next_);
  state_.pad_last_block();
  kicked_ = true;
  if (sizeof(Real) == 4) travelled_ += travel_of_step(pose);
  ++steps_;
  return sums;
}

/// Who failed in the step, the first in the caller's order; where rounding makes that none, the
/// fastest.
template <class Real>
Failure ListStepper<Real>::failure(const Pose& pose) {
  Failure failure;
  const double rounding = sizeof(Real) == 4 ? 1e-5 : 0;
  const double most = most_radii_per_step * body_->material.pair.r * (1 - rounding);
  Offender fastest{0, true, -1};
  for (std::size_t k = 0; k < caller_.size(); ++k) {
    const double moved = stepping_.step * relative_velocity(pose, k).norm();
    const bool finite = std::isfinite(moved) && next_.velocity(k, measure_).allFinite();
    const Offender one{caller_[k], finite, std::isfinite(moved) ? moved : 0};
    if (finite && moved > fastest.moved) fastest = one;
    if (!finite || moved > most) failure.all.push_back(one);
  }
  if (failure.all.empty()) failure.all.push_back(fastest);
  std::sort(failure.all.begin(), failure.all.end(),
            [](const Offender& a, const Offender& b) { return a.particle < b.particle; });
  failure.first = failure.all.front();
  return failure;
}

/// Of the velocity after the step to the leading bone, or to the velocity before it.
template <class Real>
Vec3 ListStepper<Real>::relative_velocity(const Pose& pose, std::size_t k) const {
  const int bone = body_->binding.bone(static_cast<std::size_t>(id_[k + block]));
  const Vec3 carried = bone == no_bone ? state_.velocity(k, measure_)
                                       : pose[bone].velocity_at(state_.position(k, measure_));
  return next_.velocity(k, measure_) - carried;
}

template <class Real>
Balance ListStepper<Real>::evaluate(const Pose& pose, Forces& forces) {
  place_bones(pose);
  keep_lists_true(pose);
  const std::size_t n = caller_.size(), slots = state_.blocks() * block;
  std::array<std::vector<Real>, 9> told;
  for (auto& axis : told) axis.resize(slots);
  std::vector<std::int32_t> partners(slots);
  auto now = job();
  for (int axis = 0; axis < 3; ++axis) {
    now.probed.pair[axis] = told[axis].data();
    now.probed.damping[axis] = told[3 + axis].data();
    now.probed.bone[axis] = told[6 + axis].data();
  }
  now.probed.partners = partners.data();
  parallel_split(totals_.size(), pieces_per_thread<Real>,
                 [&](std::size_t begin, std::size_t end) { kernel_.probe(now, begin, end); });
  const double newtons = mass_ * measure_.length / (measure_.time * measure_.time);
  forces.pair.resize(n);
  forces.damping.resize(n);
  forces.bone.resize(n);
  forces.neighbours.resize(n);
  parallel_split(n, particles_per_thread, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::uint32_t i = caller_[k];
      forces.pair[i] = newtons * Vec3(told[0][k], told[1][k], told[2][k]);
      forces.damping[i] = newtons * Vec3(told[3][k], told[4][k], told[5][k]);
      forces.bone[i] = newtons * Vec3(told[6][k], told[7][k], told[8][k]);
      forces.neighbours[i] = partners[k];
    }
  });
  const StepSums sums = sums_of_totals();
  Balance balance{sums.power, sums.lost, 0, 0};
  const double joules = newtons * measure_.length;
  for (const kernel::Totals& piece : totals_)
    balance.pair_energy += joules * piece.pair_energy,
        balance.bone_energy += joules * piece.bone_energy;
  return balance;
}

template <class Real>
void ListStepper<Real>::read(const Pose& pose, Particles& particles) {
  const std::size_t n = caller_.size();
  for (auto* values :
       {&particles.x, &particles.y, &particles.z, &particles.u, &particles.v, &particles.w})
    values->resize(n);
  parallel_split(n, particles_per_thread, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      particles.set_position(caller_[k], state_.position(k, measure_));
      particles.set_velocity(caller_[k], state_.velocity(k, measure_));
    }
  });
  if (stepping_.integrator != Integrator::velocity_verlet || !kicked_) return;
  Forces forces;
  evaluate(pose, forces);
  for (std::size_t i = 0; i < n; ++i)
    particles.set_velocity(
        i, particles.velocity(i) +
               stepping_.step / 2 * (forces.total(i) / particles.mass + stepping_.gravity));
}

template <class Real>
void ListStepper<Real>::save(SimulationState& state) const {
  state.moving = state_.columns();
  state.kicked = kicked_;
  state.order = caller_;
  state.whole_numbers = {measure_.length, measure_.origin, measured_box_, travelled_};
  state.mean_when_sorted = mean_when_sorted_;
}

template <class Real>
void ListStepper<Real>::restore(const SimulationState& state) {
  using Columns = MovingColumns<typename BlockState<Real>::Coord, Real>;
  const auto* moving = std::get_if<Columns>(&state.moving);
  if (moving == nullptr) throw not_a_state("it is in another precision");
  check_moving(*moving, caller_.size());
  if (!state.rest_length.empty()) throw not_a_state("it has bonds");
  restore_order(state.order);
  restore_measure(state.whole_numbers);
  state_.set_columns(*moving);
  next_ = state_;
  find_slots();
  kicked_ = state.kicked;
  mean_when_sorted_ = state.mean_when_sorted;
  steps_ = state.steps;
  order_looked_at_ = -1;
  fastest_.reset();
  lists_ = PartnerLists<Real>(kernel_, body_->material.pair, stepping_.step);
}

/// `order` names each particle's place in the caller's order once.
template <class Real>
void ListStepper<Real>::restore_order(const std::vector<std::uint32_t>& order) {
  std::vector<std::int32_t> id_of(caller_.size(), -1);
  for (std::size_t k = 0; k < caller_.size(); ++k) id_of[caller_[k]] = id_[k + block];
  if (order.size() != id_of.size()) throw not_a_state("it has no order of the particles");
  std::vector<std::int32_t> id(id_.size(), 0);
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (order[k] >= id_of.size() || id_of[order[k]] < 0)
      throw not_a_state("its order of the particles names one twice");
    id[k + block] = std::exchange(id_of[order[k]], -1);
  }
  id_ = std::move(id);
  caller_ = order;
}

template <class Real>
void ListStepper<Real>::restore_measure(const WholeNumbers& saved) {
  const bool sane = saved.length > 0 && std::isfinite(saved.length) && saved.origin.allFinite() &&
                    saved.box.min().allFinite() && saved.box.max().allFinite() &&
                    saved.travelled >= 0 && std::isfinite(saved.travelled);
  if (!sane) throw not_a_state("its measure is none");
  measure_.length = saved.length;
  measure_.origin = saved.origin;
  measured_box_ = saved.box;
  travelled_ = saved.travelled;
}

template class ListStepper<double>;
template class ListStepper<float>;

}  // namespace sinew
