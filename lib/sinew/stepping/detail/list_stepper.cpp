// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/stepping/detail/list_stepper.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <sinew/core/parallel.h>
#include <sinew/core/system.h>
#include <sinew/lists/particle_order.h>
#include <sinew/lists/still_length.h>
#include <sinew/material/laws.h>
#include <sinew/stepping/detail/force_probe.h>
#include <sinew/stepping/detail/law_functions.h>
#include <sinew/stepping/detail/step_totals.h>

namespace sinew {
namespace {

// Columns of sorted particles, in diameters; how much lists may grow before sorting is tried again.
constexpr double column_edge = 1.2, max_growth = 1.3;
// Checks go by the step count alone, so that a resumed run sorts when an uninterrupted one does:
// the last bits of sums depend on the order. Their lists cost about one step in a hundred.
constexpr std::int64_t steps_between_order_checks = 1024;

template <class Real>
ParticleLayout<Real> taken(const Body& body, Particles& particles, double step) {
  ParticleLayout<Real> layout(body, particles, step);
  free_motion(particles);
  return layout;
}

}  // namespace

template <class Real>
ListStepper<Real>::ListStepper(std::shared_ptr<const Body> body, const Stepping& stepping,
                               Particles& particles, kernel::InstructionSet instructions)
    : body_(std::move(body)),
      stepping_(stepping),
      mass_(particles.mass),
      extent_(bounds(body_->rest).diagonal().norm()),
      kernel_(kernel::functions_of<Real>(instructions)),
      law_(kernel_law(*body_)),
      work_(law_functions(*body_, kernel_)),
      layout_(taken<Real>(*body_, particles, stepping.step)),
      bonds_(bond_lists<Real>(*body_, mass_, layout_.id(), layout_.units())),
      strain_(strain_lists<Real>(*body_, mass_, layout_.id(), bonds_, layout_.units())),
      surroundings_(body_, stepping, particles.mass, kernel_.kept),
      groups_(body_, particles.mass, kernel_),
      brakes_(body_),
      lists_(kernel_, body_->material, stepping.step) {
  find_slots();
  groups_.begin(layout_.now, layout_.units());
  const std::size_t blocks = layout_.now.blocks();
  if (body_->material.damping_form != DampingForm::paper && body_->material.damping > 0)
    inverse_count_.assign((blocks + 2) * block, 0);
  totals_.resize((blocks + kernel::blocks_per_piece - 1) / kernel::blocks_per_piece);
}

/// What depends on the order of the particles and on the units.
template <class Real>
void ListStepper<Real>::find_slots() {
  slots_ = bone_slots<Real>(*body_, layout_.id(), layout_.units());
  lists_.let_pass(*body_, layout_.id());
  surroundings_.set_order(layout_.id());
  groups_.set_order(layout_.id(), bonds_, !strain_.empty());
  brakes_.set_order(layout_.id());
  counted_ = false;
  masses_.assign(body_->density.empty() ? 0 : layout_.now.blocks() * block, 1);
  for (std::size_t k = 0; k < layout_.size() && !masses_.empty(); ++k)
    masses_[k] = static_cast<Real>(body_->density[static_cast<std::size_t>(layout_.id()[k])]);
}

template <class Real>
kernel::Bindings<Real> ListStepper<Real>::bindings() const {
  const auto& [first, slots, attachments, weights, center] = slots_;
  return {first.data(), slots.data(), attachments.data(), weights.data(), bones_.data()};
}

template <class Real>
kernel::Step<Real> ListStepper<Real>::job() {
  const Material& material = body_->material;
  const PairForce& pair = material.pair;
  const double T = layout_.units().time, dt = stepping_.step;
  const auto real = [](double value) { return static_cast<Real>(value); };
  kernel::Step<Real> step{};
  step.before = layout_.now.arrays();
  step.after = layout_.next.arrays();
  step.blocks = layout_.now.blocks();
  step.id = layout_.padded_id();
  step.live = layout_.now.live();
  step.lists = lists_.arrays();
  step.subpieces = lists_.subpieces();
  step.bindings = bindings();
  step.rigid = brakes_.arrays(layout_.units());
  step.law = law_in<Real>(layout_.units(), pair, material.damping, mass_);
  step.bonds = bonds_.arrays(material, dt);
  strain_.put_into(step);
  if constexpr (sizeof(Real) == 8) careful_.resize(layout_.now.blocks() * block);
  step.careful = careful_.data();
  step.inverse_count = inverse_count_.empty() ? nullptr : inverse_count_.data() + block;
  step.central = acts_along_pairs(material.damping_form);
  step.mass = masses_.empty() ? nullptr : masses_.data();
  step.loads = surroundings_.loads();
  step.grouped = groups_.arrays();
  for (int axis = 0; axis < 3; ++axis)
    step.gravity[axis] = real(layout_.units().acceleration(stepping_.gravity[axis]));
  const bool first_of_verlet = stepping_.integrator == Integrator::velocity_verlet && !kicked_;
  step.keep = 1;
  step.kick = real(dt / T * (first_of_verlet ? 0.5 : 1));
  step.drift = real(dt / T);
  step.middle = real(dt / T / 2);
  step.drift_first = stepping_.integrator == Integrator::explicit_euler;
  const double most = layout_.units().velocity(max_radii_ * pair.r / dt);
  step.most = real(most * most);
  step.totals = totals_.data();
  return step;
}

template <class Real>
void ListStepper<Real>::on_all_pieces(const std::function<void(std::size_t, std::size_t)>& run) {
  const bool uneven = surroundings_.any() || groups_.any();
  if (uneven && totals_.size() >= 2 * pieces_per_thread)  // what is touched takes longer
    parallel_for(totals_.size(), pieces_at_a_time, run);
  else
    parallel_split(totals_.size(), pieces_per_thread, run);
}

/// Puts what pins hold at its place.
template <class Real>
void ListStepper<Real>::hold(const TimedPose& now) {
  moved_.resize(totals_.size());
  surroundings_.hold(now.pose, now.time, layout_.now, layout_.units(), moved_);
}

/// The work at the pose, with what must be known of all particles before; `whole`: of groups, too.
template <class Real>
kernel::Step<Real> ListStepper<Real>::begin(const TimedPose& moment, Points* world_forces,
                                            bool whole) {
  const auto& [time, pose] = moment;
  hold(moment);
  update_lists();
  if (whole) groups_.show_all(layout_.now, layout_.units());
  groups_.watch(lists_.arrays(), lists_.take_changed(), bonds_,
                [this](std::size_t piece) { return lists_.meets_others(piece); });
  groups_.place(layout_.now, layout_.units());
  if (!whole) groups_.activate(layout_.now, layout_.units());
  bones_ = bones_now<Real>(*body_, pose, slots_.center, mass_, layout_.units());
  brakes_.find(steps_, moment, *this, layout_.now, layout_.units());
  surroundings_.begin(pose, time, layout_.now, layout_.units(), lists_, world_forces);
  if (has_muscles(*body_))
    strain_.fibers.set_activations(activations_at(body_->world->muscles, time));
  auto now = job();
  if (whole) now.grouped = {};
  find_deformation(now);
  return now;
}

template <class Real>
void ListStepper<Real>::find_deformation(const kernel::Step<Real>& now) {
  if (!strain_.empty())
    on_all_pieces([&](std::size_t first, std::size_t last) { kernel_.strain(now, first, last); });
  find_flow(now);
  if (inverse_count_.empty()) return;
  auto counting = now;
  if (!std::exchange(counted_, true)) {
    counting.grouped = {};  // within groups, the neighbors of idle blocks remain
    bonds_count_.assign(totals_.size(), 0);
  }
  on_all_pieces([&](std::size_t first, std::size_t last) {
    for (std::size_t piece = first; piece < last; ++piece) {
      if (bonds_count_[piece] != 0 && !totals_[piece].broke && meets_none(now, piece)) continue;
      work_.count(counting, piece, piece + 1);
      bonds_count_[piece] = is_bonded(law_) && !groups_.any() && meets_none(now, piece) ? 1 : 0;
    }
  });
}

/// Whether no particle of a piece may touch one that it is not bonded to.
template <class Real>
bool ListStepper<Real>::meets_none(const kernel::Step<Real>& now, std::size_t piece) const {
  const std::uint32_t* first = now.lists[piece].first;
  return first[0] ==
         first[std::min(kernel::blocks_per_piece, now.blocks - piece * kernel::blocks_per_piece)];
}

template <class Real>
ListCounts ListStepper<Real>::counts() const {
  ListCounts counts = lists_.counts();
  counts.sorts = sorts_;
  counts.sorting = sorting_;
  return counts;
}

template <class Real>
std::vector<std::int32_t> ListStepper<Real>::broken_bonds() const {
  const bool bonded = is_bonded(law_);
  std::vector<std::int32_t> broken(bonded ? layout_.caller().size() : 0);
  for (std::size_t k = 0; k < broken.size() && !bonds_.broken.empty(); ++k)
    broken[layout_.caller()[k]] = bonds_.broken[k];
  return broken;
}

template <class Real>
StepSums ListStepper<Real>::sums_of_totals() const {
  StepSums sums = sums_of(totals_, layout_.units(), mass_);
  const WorldSums world = surroundings_.sums();
  sums.power += groups_.sums().power;
  sums.lost = sums.lost + world.lost + groups_.sums().lost;
  sums.world_power += world.power;
  sums.held_kinetic = world.held_kinetic;
  return sums;
}

template <class Real>
void ListStepper<Real>::advance(std::span<const TimedPose> begins, std::vector<StepSums>& sums) {
  for (const TimedPose& now : begins) {
    sums.push_back(run(begin(now, nullptr, false), now.pose));
    if (sums.back().failure) return;
    accept();
  }
}

template <class Real>
WorldReactions ListStepper<Real>::reactions() const {
  WorldReactions all{surroundings_.reactions(), surroundings_.reactions_of_pins(),
                     surroundings_.support_reactions(), surroundings_.load_reactions()};
  all.add(of_brakes_);
  return all;
}

template <class Real>
StepSums ListStepper<Real>::run(kernel::Step<Real> now, const Pose& pose) {
  const auto work = work_.step[inverse_count_.empty() ? kernel::to_the_mean : kernel::pairwise];
  on_all_pieces(
      [&](std::size_t first, std::size_t last) { surroundings_.run(work, now, first, last); });
  if (groups_.any()) surroundings_.refuse_contact_of_groups();
  move_groups(now);
  StepSums sums = sums_of_totals();
  if (!std::all_of(totals_.begin(), totals_.end(),
                   [](const kernel::Totals& piece) { return piece.sound; })) {
    sums.failure = failure(pose);
    lists_ = lists_.cleared(stepping_.step);  // bonds stay broken
  }
  return sums;
}

template <class Real>
void ListStepper<Real>::move_groups(const kernel::Step<Real>& now) {
  if (!groups_.any()) return;
  const auto seconds = [T = layout_.units().time](Real time) {
    return static_cast<double>(time) * T;
  };
  const GroupStep by{seconds(now.kick), seconds(now.drift), seconds(now.middle), now.drift_first,
                     stepping_.gravity};
  const auto meets = [this](std::size_t piece) { return lists_.meets_others(piece); };
  groups_.step(bonds_, now, layout_.units(), by, meets, totals_);
}

template <class Real>
void ListStepper<Real>::accept() {
  groups_.advance();
  layout_.advance(travel_of_step());
  bonds_.branches.advance(stepping_.step);
  kicked_ = stepped_ = true;
  ++steps_;
}

template <class Real>
void ListStepper<Real>::update_lists() {
  if (layout_.units_are_due()) groups_.show_all(layout_.now, layout_.units());
  const bool stepped = std::exchange(stepped_, false), resized = layout_.change_units();
  if (resized) follow_units();
  add_moved();
  if (order_check_due()) {
    make_lists();
    if (lists_.mean_of_outer() > max_growth * mean_when_sorted_) sort();
  } else if (resized || !lists_.made()) {
    make_lists();
  } else if (stepped) {
    lists_.follow(layout_.now, bonds_, layout_.units(), totals_,
                  groups_.seen(layout_.now, layout_.units()));
  }
}

/// What pins moved counts as faster motion of the step before.
template <class Real>
void ListStepper<Real>::add_moved() {
  for (std::size_t piece = 0; piece < moved_.size(); ++piece) {
    const double moved = std::exchange(moved_[piece], 0) / layout_.units().length;
    if (moved > 0 && lists_.made()) lists_.add_moved(piece, moved);
  }
}

template <class Real>
void ListStepper<Real>::follow_units() {
  find_slots();
  bonds_.set_units(*body_, layout_.id(), mass_, layout_.units());
  strain_ = strain_lists<Real>(*body_, mass_, layout_.id(), bonds_, layout_.units());
}

template <class Real>
void ListStepper<Real>::make_lists() {
  lists_.make(layout_.now, subpieces_of(*body_, layout_.id(), block), bonds_, layout_.units(),
              groups_.seen(layout_.now, layout_.units()));
}

/// What keeps its neighbors keeps its order. A second check before the same step, as in a run
/// resumed there, would change nothing.
template <class Real>
bool ListStepper<Real>::order_check_due() {
  return has_no_memory(law_) && !groups_.any() && steps_ % steps_between_order_checks == 0 &&
         std::exchange(order_checked_, steps_) != steps_;
}

/// Sorts the particles into columns where that makes the lists shorter.
template <class Real>
void ListStepper<Real>::sort() {
  Stopwatch watch;
  auto order = order_by_columns(layout_.now,
                                column_edge * 2 * body_->material.pair.r / layout_.units().length);
  VerletLists<Real> before = std::exchange(lists_, lists_.cleared(stepping_.step));
  const double unsorted = before.mean_of_outer();
  layout_.reorder(order);
  lists_.let_pass(*body_, layout_.id());
  lists_.make_some(layout_.now, subpieces_of(*body_, layout_.id(), block), bonds_, layout_.units());
  const double sorted = lists_.mean_of_outer();
  mean_when_sorted_ = std::min(sorted, unsorted);
  if (sorted > 0.95 * unsorted) {
    layout_.reorder(order);
    lists_ = std::move(before);
  } else {
    ++sorts_;
    if (!lists_.whole()) make_lists();
    find_slots();
    bonds_ = bond_lists<Real>(*body_, mass_, layout_.id(), layout_.units());  // bonds of muscles
    strain_ = strain_lists<Real>(*body_, mass_, layout_.id(), bonds_, layout_.units());
  }
  sorting_ += watch.lap();
}

/// How far any particle has traveled in the step, m.
template <class Real>
double ListStepper<Real>::travel_of_step() const {
  double speed2 = 0;
  for (const kernel::Totals& piece : totals_) speed2 = std::max(speed2, piece.speed2);
  return 1.001 * std::sqrt(speed2) * layout_.units().length / layout_.units().time * stepping_.step;
}

template <class Real>
void ListStepper<Real>::set_step(double step) {
  stepping_.step = step;
  surroundings_.set_step(step);
  lists_ = lists_.cleared(step);
  order_checked_ = -1;
  stepped_ = false;
}

template <class Real>
void ListStepper<Real>::save(SimulationState& state) {
  groups_.show_all(layout_.now, layout_.units());
  layout_.save(state);
  groups_.save(state);
  bonds_.save(state);
  surroundings_.save(state);
  brakes_.save(state);
  state.kicked = kicked_;
  put_column(state, "lists", "mean_when_sorted", std::vector{mean_when_sorted_});
}

template <class Real>
void ListStepper<Real>::restore(const SimulationState& state) {
  if (find_part(state, "bonds of cells") != nullptr) throw not_a_state("it is of cells");
  const auto sorted = column_of<double>(state, "lists", "mean_when_sorted");
  ParticleLayout<Real> layout = layout_;
  layout.restore(state);
  auto bonds = bond_lists<Real>(*body_, mass_, layout.id(), layout.units());
  bonds.restore(state);
  layout_ = std::move(layout);
  bonds_ = std::move(bonds);
  strain_ = strain_lists<Real>(*body_, mass_, layout_.id(), bonds_, layout_.units());
  groups_ = Groups<Real>(body_, mass_, kernel_);
  brakes_.restore(state);
  find_slots();
  groups_.restore(state);
  surroundings_.restore(state);
  kicked_ = state.kicked;
  mean_when_sorted_ = sorted.empty() ? 0 : sorted.front();
  steps_ = state.steps;
  order_checked_ = -1;
  stepped_ = false;
  lists_ = lists_.cleared(stepping_.step);
}

template <class Real>
Balance ListStepper<Real>::evaluate(const TimedPose& moment, Forces& forces) {
  Points of_world;
  const auto now = begin(moment, surroundings_.any() ? &of_world : nullptr, true);
  const double newtons =
      mass_ * layout_.units().length / (layout_.units().time * layout_.units().time);
  const auto work = work_.probe[inverse_count_.empty() ? kernel::to_the_mean : kernel::pairwise];
  const auto probed = [&](const kernel::Step<Real>& job, std::size_t first, std::size_t last) {
    surroundings_.run(work, job, first, last);
  };
  const ForceProbe<Real> probe(probed, now, layout_, newtons, has_muscles(*body_), of_world);
  resize(forces, layout_.size(), body_->world != nullptr || surroundings_.any());
  on_all_pieces([&](std::size_t first, std::size_t last) { probe(first, last, forces); });
  groups_.constrain(forces, layout_.caller(), stepping_.gravity);
  of_brakes_ = brakes_.reactions(layout_.now, layout_.units(), mass_);
  const StepSums sums = sums_of_totals();
  Balance balance{sums.power, sums.lost, 0, 0, sums.world_power, 0, sums.held_kinetic};
  balance.contact_energy = surroundings_.sums().contact_energy;
  const double joules = newtons * layout_.units().length;
  for (const kernel::Totals& piece : totals_) {
    balance.pair_energy += joules * piece.pair_energy;
    balance.bone_energy += joules * piece.bone_energy;
  }
  return balance;
}

template <class Real>
void ListStepper<Real>::read(const TimedPose& now, Particles& particles) {
  hold(now);
  groups_.show_all(layout_.now, layout_.units());
  layout_.read(particles);
  if (stepping_.integrator != Integrator::velocity_verlet || !kicked_) return;
  Forces forces;
  evaluate(now, forces);
  for (std::size_t i = 0; i < particles.size(); ++i)
    particles.set_velocity(
        i, particles.velocity(i) +
               stepping_.step / 2 *
                   (forces.total(i) /
                        mass_of(*body_, static_cast<std::size_t>(particles.id[i]), mass_) +
                    stepping_.gravity));
}

// Where bonds may flow is found before a step, but only of pieces that may have come to it since
// they were looked at, which most of a body has not.

template <class Real>
void ListStepper<Real>::find_flow(const kernel::Step<Real>& now) {
  if (bonds_.look.empty()) return;
  const auto flows = [&](std::size_t piece) { return bonds_.look[piece].spare <= 0; };
  const std::vector<std::uint32_t> pieces = lists_.to_look_at(flows);
  parallel_for(pieces.size(), pieces_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) kernel_.flow(now, pieces[k], pieces[k] + 1);
  });
  const bool relaxes = now.bonds.branches > 0;  // whose stress changes while nothing moves
  const double diameter = 2 * body_->material.pair.r / layout_.units().length;
  for (const std::uint32_t piece : pieces)
    lists_.looked_at(
        piece, relaxes ? 0 : still_length(bonds_.look[piece], diameter, lists_.outer_range()));
}

/// The particles that failed, in the caller's order; the fastest one where rounding leaves none.
template <class Real>
Failure ListStepper<Real>::failure(const Pose& pose) {
  Failure failure;
  // Less 1e-5 for rounding in single precision.
  const double most = max_radii_ * body_->material.pair.r * (1 - (sizeof(Real) == 4 ? 1e-5 : 0));
  Offender fastest{0, true, -1};
  for (std::size_t k = 0; k < layout_.caller().size(); ++k) {
    if (groups_.is_idle(k)) continue;
    const double moved = stepping_.step * relative_velocity(pose, k).norm();
    const bool finite =
        std::isfinite(moved) && layout_.next.velocity(k, layout_.units()).allFinite();
    const Offender one{layout_.caller()[k], finite, std::isfinite(moved) ? moved : 0};
    if (finite && moved > fastest.moved) fastest = one;
    if (!finite || moved > most) failure.all.push_back(one);
  }
  if (failure.all.empty()) failure.all.push_back(fastest);
  std::sort(failure.all.begin(), failure.all.end(),
            [](const Offender& a, const Offender& b) { return a.particle < b.particle; });
  failure.first = failure.all.front();
  return failure;
}

/// Velocity after the step relative to the leading bone or, without one and for what is held, to
/// the velocity before.
template <class Real>
Vec3 ListStepper<Real>::relative_velocity(const Pose& pose, std::size_t k) const {
  const int bone = body_->binding.bone(static_cast<std::size_t>(layout_.padded_id()[k]));
  const Vec3 carried = bone == no_bone || surroundings_.is_held(k)
                           ? layout_.now.velocity(k, layout_.units())
                           : pose[bone].velocity_at(layout_.now.position(k, layout_.units()));
  return layout_.next.velocity(k, layout_.units()) - carried;
}

template <class Real>
StepSums ListStepper<Real>::try_step(const TimedPose& moment, double keep) {
  auto now = begin(moment, nullptr, false);
  now.relaxes = true;
  now.keep = static_cast<Real>(keep);
  now.kick = static_cast<Real>(stepping_.step / layout_.units().time * (1 + keep) / 2);
  StepSums sums = run(now, moment.pose);
  sums.imbalance = imbalance();
  return sums;
}

template <class Real>
void ListStepper<Real>::place(const Points& positions, Move move) {
  for (std::size_t k = 0; k < layout_.size(); ++k)
    layout_.now.set_position(k, positions[layout_.caller()[k]], layout_.units());
  if (move == Move::slight) return;
  lists_ = lists_.cleared(stepping_.step);
  stepped_ = false;
}

template <class Real>
Imbalance ListStepper<Real>::imbalance() const {
  Imbalance sum = imbalance_of(totals_, layout_.units(), mass_);
  const double weight = total_mass(*body_, mass_) * stepping_.gravity.norm();
  const double loaded = surroundings_.loaded();
  sum.applied = std::max({sum.applied, surroundings_.sums().applied + loaded, weight});
  sum.loaded = loaded + weight;
  for (const Reaction& support : surroundings_.support_reactions())
    sum.applied = std::max({sum.applied, support.force.norm(), support.moment.norm() / extent_});
  return sum;
}

template <class Real>
void ListStepper<Real>::regroup() {
  groups_.show_all(layout_.now, layout_.units());
  std::vector<std::int32_t> id(layout_.size());
  std::vector<std::uint32_t> place(layout_.size());
  for (std::uint32_t k = 0; k < place.size(); ++k) {
    const std::uint32_t i = layout_.caller()[k];
    id[i] = layout_.id()[k];
    place[i] = k;
  }
  std::vector<std::uint32_t> order = order_at_rest(*body_, id);
  for (std::uint32_t& one : order) one = place[one];
  layout_.reorder(order);
  groups_ = Groups<Real>(body_, mass_, kernel_);
  bonds_ = bond_lists<Real>(*body_, mass_, layout_.id(), layout_.units());  // none has changed
  strain_ = strain_lists<Real>(*body_, mass_, layout_.id(), bonds_, layout_.units());
  find_slots();
  groups_.begin(layout_.now, layout_.units());
  lists_ = lists_.cleared(stepping_.step);
  stepped_ = false;
}

template <class Real>
std::vector<ConstrainedCell> ListStepper<Real>::constrained_cells(
    std::span<const std::int32_t> cell, std::size_t cells) const {
  std::vector<ConstrainedCell> constrained(cells);
  groups_.add_constrained(cell, layout_.units(), constrained);
  return constrained;
}

template class ListStepper<double>;
template class ListStepper<float>;

}  // namespace sinew
