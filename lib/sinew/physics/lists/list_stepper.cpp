// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/physics/lists/list_stepper.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <sinew/core/parallel.h>

namespace sinew {
template <class Real>
ListStepper<Real>::ListStepper(std::shared_ptr<const Body> body, const Stepping& stepping,
                               const Particles& particles, kernel::InstructionSet instructions)
    : body_(std::move(body)),
      stepping_(stepping),
      mass_(particles.mass),
      kernel_(kernel::functions_of<Real>(instructions)),
      comoving_frames_(*body_),
      lists_(kernel_, body_->material.pair, stepping.step) {
  load(particles);
}

template <class Real>
void ListStepper<Real>::load(const Particles& particles) {
  const std::size_t n = particles.size();
  Box box;
  for (std::size_t i = 0; i < n; ++i) box.extend(particles.position(i));
  units_box_ = box;
  units_ = units_for<Real>(box, body_->material.pair, stepping_.step);
  state_ = next_ = BlockState<Real>(n);
  id_.assign((state_.blocks() + 2) * block, 0);
  caller_.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    caller_[k] = static_cast<std::uint32_t>(k);
    id_[k + block] = particles.id[k];
    state_.set_position(k, particles.position(k), units_);
    state_.set_velocity(k, particles.velocity(k), units_);
  }
  find_slots();
  totals_.resize((state_.blocks() + kernel::blocks_per_piece - 1) / kernel::blocks_per_piece);
}

template <class Real>
void ListStepper<Real>::find_slots() {
  slots_ = bone_slots<Real>(*body_, {id_.data() + block, caller_.size()}, units_);
}

template <class Real>
void ListStepper<Real>::place_bones(const Pose& pose) {
  bones_ = bones_now<Real>(*body_, pose, slots_.center, mass_, units_);
}

template <class Real>
kernel::Holds<Real> ListStepper<Real>::holds() const {
  return {slots_.first.data(), slots_.slots.data(), slots_.held.data(), slots_.shares.data(),
          bones_.data()};
}

template <class Real>
kernel::ComovingFrames<Real> ListStepper<Real>::comoving_frames() const {
  return {frame_slots_.first.data(), frame_slots_.slots.data(), frame_slots_.lanes.data(),
          frames_.data()};
}

template <class Real>
void ListStepper<Real>::place_comoving_frames(const Pose& pose) {
  comoving_pose_ = comoving_frames_.at(pose);
  frames_.clear();
  for (std::size_t c = 0; c < comoving_pose_.size(); ++c)
    frames_.push_back(c < bones_.size() ? bones_[c].frame
                                        : frame_now<Real>(comoving_pose_[c],
                                                          comoving_pose_[c].frame.origin, units_));
  frames_.push_back(frame_now<Real>(BonePose(), units_.origin, units_));
}

template <class Real>
kernel::Step<Real> ListStepper<Real>::job() {
  const Material& material = body_->material;
  const PairForce& pair = material.pair;
  const double L = units_.length, T = units_.time, dt = stepping_.step;
  const auto real = [](double value) { return static_cast<Real>(value); };
  kernel::Step<Real> step{};
  step.before = state_.arrays();
  step.after = next_.arrays();
  step.blocks = state_.blocks();
  step.id = id_.data() + block;
  step.lists = lists_.arrays();
  step.holds = holds();
  step.comoving_frames = comoving_frames();
  const double per_mass = pair.r * T * T / mass_;
  step.law = {real(pair.r / L),
              real(pair.a / L),
              real(pair.b / L),
              real(pair.b / L * pair.b / L),
              real(pair.k1 * per_mass),
              real(pair.k2 * per_mass),
              real(material.damping * T / mass_)};
  for (int axis = 0; axis < 3; ++axis)
    step.gravity[axis] = real(units_.acceleration(stepping_.gravity[axis]));
  const bool first_of_verlet = stepping_.integrator == Integrator::velocity_verlet && !kicked_;
  step.kick = real(dt / T * (first_of_verlet ? 0.5 : 1));
  step.drift = real(dt / T);
  step.middle = real(dt / T / 2);
  step.drift_first = stepping_.integrator == Integrator::explicit_euler;
  const double most = units_.velocity(most_radii_per_step * pair.r / dt);
  step.most = real(most * most);
  step.totals = totals_.data();
  return step;
}

template <class Real>
MovingParticles<Real> ListStepper<Real>::particles() {
  return {state_, units_, comoving_frames(), comoving_frames_.of_particles(), comoving_pose_};
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
  // Per unit of mass and in the kernel's units; converted to watts.
  const double watts =
      mass_ * units_.length * units_.length / (units_.time * units_.time * units_.time);
  StepSums sums;
  for (const kernel::Totals& piece : totals_)  // in this order, whichever thread made them
    sums.power += piece.power, sums.lost += piece.lost;
  sums.power *= watts;
  sums.lost *= watts;
  return sums;
}

template <class Real>
StepSums ListStepper<Real>::step(const Pose& pose) {
  place_bones(pose);
  update_lists(pose);
  const auto now = job();
  parallel_split(totals_.size(), pieces_per_thread,
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
  fastest_ = std::sqrt(fastest) * units_.length / units_.time;
  std::swap(state_, next_);
  state_.pad_last_block();
  kicked_ = true;
  if (sizeof(Real) == 4) traveled_ += travel_of_step(pose);
  ++steps_;
  return sums;
}

/// The particles that failed in the step, in the caller's order; where rounding leaves none, the
/// fastest.
template <class Real>
Failure ListStepper<Real>::failure(const Pose& pose) {
  Failure failure;
  const double rounding = sizeof(Real) == 4 ? 1e-5 : 0;
  const double most = most_radii_per_step * body_->material.pair.r * (1 - rounding);
  Offender fastest{0, true, -1};
  for (std::size_t k = 0; k < caller_.size(); ++k) {
    const double moved = stepping_.step * relative_velocity(pose, k).norm();
    const bool finite = std::isfinite(moved) && next_.velocity(k, units_).allFinite();
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

/// Velocity after the step relative to the leading bone or, without a bone, to the velocity before
/// it.
template <class Real>
Vec3 ListStepper<Real>::relative_velocity(const Pose& pose, std::size_t k) const {
  const int bone = body_->binding.bone(static_cast<std::size_t>(id_[k + block]));
  const Vec3 carried = bone == no_bone ? state_.velocity(k, units_)
                                       : pose[bone].velocity_at(state_.position(k, units_));
  return next_.velocity(k, units_) - carried;
}

template <class Real>
Balance ListStepper<Real>::evaluate(const Pose& pose, Forces& forces) {
  place_bones(pose);
  update_lists(pose);
  const std::size_t n = caller_.size(), slots = state_.blocks() * block;
  std::array<std::vector<Real>, 9> probed;
  for (auto& axis : probed) axis.resize(slots);
  std::vector<std::int32_t> neighbors(slots);
  auto now = job();
  for (int axis = 0; axis < 3; ++axis) {
    now.probed.pair[axis] = probed[axis].data();
    now.probed.damping[axis] = probed[3 + axis].data();
    now.probed.bone[axis] = probed[6 + axis].data();
  }
  now.probed.neighbors = neighbors.data();
  parallel_split(totals_.size(), pieces_per_thread,
                 [&](std::size_t begin, std::size_t end) { kernel_.probe(now, begin, end); });
  const double newtons = mass_ * units_.length / (units_.time * units_.time);
  forces.pair.resize(n);
  forces.damping.resize(n);
  forces.bone.resize(n);
  forces.neighbors.resize(n);
  parallel_split(n, particles_per_thread, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::uint32_t i = caller_[k];
      forces.pair[i] = newtons * Vec3(probed[0][k], probed[1][k], probed[2][k]);
      forces.damping[i] = newtons * Vec3(probed[3][k], probed[4][k], probed[5][k]);
      forces.bone[i] = newtons * Vec3(probed[6][k], probed[7][k], probed[8][k]);
      forces.neighbors[i] = neighbors[k];
    }
  });
  const StepSums sums = sums_of_totals();
  Balance balance{sums.power, sums.lost, 0, 0};
  const double joules = newtons * units_.length;
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
      particles.set_position(caller_[k], state_.position(k, units_));
      particles.set_velocity(caller_[k], state_.velocity(k, units_));
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

template class ListStepper<double>;
template class ListStepper<float>;

}  // namespace sinew
