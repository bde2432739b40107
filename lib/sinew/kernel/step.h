// SPDX-License-Identifier: GPL-3.0-or-later
// A whole step of a vector of particles, from the state before to the state after, and the sums of
// a piece of blocks. Lanes are summed in their order within the block, whatever the width.
#pragma once

#include <type_traits>

#include <sinew/kernel/bonds.h>
#include <sinew/kernel/bones.h>
#include <sinew/kernel/changing_bonds.h>
#include <sinew/kernel/fetching.h>
#include <sinew/kernel/pairs.h>
#include <sinew/kernel/rigid_damping.h>
#include <sinew/kernel/strain.h>

namespace sinew::kernel {

/// Sums of a piece, by place in the block.
template <class L>
struct Sums {
  using Real = typename L::Real;
  static constexpr int block = Traits<Real>::block;
  Real power[block] = {}, lost[block] = {}, pair_energy[block] = {}, bone_energy[block] = {};
  Real driven_power[block] = {}, fastest[block] = {}, speed2[block] = {};
  Real aa[block] = {}, av[block] = {}, vv[block] = {}, unbalanced[block] = {}, pulled[block] = {};
  bool sound = true, broke = false;
  std::uint32_t subpiece = 0;  ///< subpiece of `fastest`
};

template <class L>
struct Forces {
  PairSums<L> pairs;
  Triple<L> damping;
  BoneSums<L> bones;
  Triple<L> muscle = none<L>();
  Braking<L> rigid = {};
  Triple<L> acceleration;
  bool strained = false;  ///< a bond creeps or breaks
};

/// What a law needs in all lanes.
template <class L, PairLaw pairs>
using LawOf = std::conditional_t<has_no_memory(pairs), PullLaw<L>, SolidLaw<L>>;

template <class L, PairLaw pairs>
SINEW_INLINE LawOf<L, pairs> law_of(const Step<typename L::Real>& step) {
  if constexpr (has_no_memory(pairs))
    return PullLaw<L>(step.law);
  else
    return SolidLaw<L>(step);
}

template <class L, PairLaw pairs, Pass pass, bool energy>
SINEW_INLINE PairSums<L> sums_of(const Step<typename L::Real>& step, const LawOf<L, pairs>& law,
                                 std::size_t block, int lane, bool& strained) {
  if constexpr (!has_no_memory(pairs)) {
    return partner_sums<L, pairs, pass, energy>(step, law, block, lane, strained);
  } else {
    const std::ptrdiff_t i =
        static_cast<std::ptrdiff_t>(block) * Traits<typename L::Real>::block + lane;
    const Lists& lists = step.lists[block / blocks_per_piece];
    const std::uint32_t* first = lists.first + block % blocks_per_piece;
    if constexpr (pairs == between_all)
      return pair_sums<L, pass, energy>(
          step, law, i, Differences<L>{lists.value + first[0], lists.value + first[1]});
    else
      return pair_sums<L, pass, energy>(
          step, law, i,
          DifferencesOfLanes<L>{lists.value + first[0], lists.value + first[1],
                                lists.lanes + first[0], lane, L::all(step.law.b2)});
  }
}

template <class L, bool energy>
SINEW_INLINE void add_volumes(const Step<typename L::Real>& step, std::size_t block, int lane,
                              std::ptrdiff_t i, PairSums<L>& sums) {
  sums.force = sums.force + thrust_force<L>(step, step.volumes.thrust, block, lane, i);
  if constexpr (energy) sums.energy = sums.energy + volume_energy<L>(step.volumes, i);
}

template <class Real>
SINEW_INLINE bool is_loaded(const Loads<Real>& loads, std::size_t block) {
  return loads.on != nullptr && loads.on[block] != 0;
}

template <class L, PairLaw pairs, Pass pass, bool energy>
SINEW_INLINE Forces<L> forces_on(const Step<typename L::Real>& step, const LawOf<L, pairs>& law,
                                 std::size_t block, int lane, const Place<L>& here,
                                 const Triple<L>& velocity) {
  const std::ptrdiff_t i =
      static_cast<std::ptrdiff_t>(block) * Traits<typename L::Real>::block + lane;
  Forces<L> forces;
  // First: this long chain of operations completes while those of the pairs run.
  forces.bones = bone_sums<L, energy>(step, block, lane, here, velocity);
  forces.pairs = sums_of<L, pairs, pass, energy>(step, law, block, lane, forces.strained);
  if constexpr (is_bonded(pairs))
    if (step.volumes.stiffness != nullptr)
      add_volumes<L, energy>(step, block, lane, i, forces.pairs);
  if (step.fibers.count > 0) forces.muscle = fiber_force<L>(step, block, lane, i);
  forces.damping = damping_of<L, pass>(forces.pairs, L::all(step.law.damping), velocity);
  forces.acceleration = forces.pairs.force + forces.damping +
                        (forces.bones.spring + forces.bones.damping) + all<L>(step.gravity);
  if (step.fibers.count > 0) forces.acceleration = forces.acceleration + forces.muscle;
  if (step.rigid.rate > 0) {
    forces.rigid = braking<L>(step, block, lane, here, velocity);
    forces.acceleration = forces.acceleration + forces.rigid.force;
  }
  if (is_loaded(step.loads, block))
    forces.acceleration = forces.acceleration + load<L>(step.loads.acceleration, i);
  if (step.mass != nullptr) {
    const Triple<L> gravity = all<L>(step.gravity);
    forces.acceleration =
        L::all(1) / L::load(step.mass + i) * (forces.acceleration - gravity) + gravity;
  }
  return forces;
}

template <class Real>
SINEW_INLINE bool is_touched(const Surroundings<Real>& surroundings, std::size_t block) {
  return surroundings.touched != nullptr && surroundings.touched[block] != 0;
}

/// Number of Forces<L> of a piece.
template <class L>
inline constexpr std::size_t kept_forces =
    blocks_per_piece* Traits<typename L::Real>::block / L::width;

/// Row of a vector of a block, in its piece.
template <class L>
SINEW_INLINE std::ptrdiff_t row_of(std::size_t block, int lane) {
  return static_cast<std::ptrdiff_t>(block % blocks_per_piece) * Traits<typename L::Real>::block +
         lane;
}

template <class L>
SINEW_INLINE Forces<L>& place_of_forces(const Step<typename L::Real>& step, std::ptrdiff_t row) {
  return static_cast<Forces<L>*>(step.surroundings.forces)[row / L::width];
}

template <class L>
[[gnu::noinline]] void keep(const Step<typename L::Real>& step, std::ptrdiff_t row,
                            const Forces<L>& forces) {
  place_of_forces<L>(step, row) = forces;
  store<L>(step.surroundings.acceleration, row, forces.acceleration);
}

/// After the surroundings have acted. Particles that pins hold move as prescribed.
template <class L>
[[gnu::noinline]] Forces<L> kept(const Step<typename L::Real>& step, std::ptrdiff_t row,
                                 const Triple<L>& velocity) {
  Forces<L> forces = place_of_forces<L>(step, row);
  forces.acceleration = load<L>(step.surroundings.acceleration, row);
  const auto prescribed = L::less(L::all(0), L::load(step.surroundings.held + row));
  const Triple<L>& carried = forces.bones.carried;
  forces.bones.carried = {L::pick(prescribed, velocity.x, carried.x),
                          L::pick(prescribed, velocity.y, carried.y),
                          L::pick(prescribed, velocity.z, carried.z)};
  return forces;
}

/// What moves a group is stored.
template <class L>
SINEW_INLINE void gather_if_grouped(const Grouped<typename L::Real>& grouped, std::size_t block,
                                    int lane, const Triple<L>& acceleration) {
  if (grouped.role == nullptr || grouped.role[block] < 0) return;
  constexpr int size = Traits<typename L::Real>::block;
  store<L>(grouped.acceleration, static_cast<std::ptrdiff_t>(grouped.role[block]) * size + lane,
           acceleration);
}

/// The ledger: power of the bones, and losses at the velocity in the middle of the step.
template <class L>
SINEW_INLINE void account(const Step<typename L::Real>& step, const Forces<L>& forces,
                          const Triple<L>& velocity, std::size_t block, int lane, Sums<L>& sums) {
  const Triple<L> middle = fused<L>(L::all(step.middle), forces.acceleration, velocity);
  typename L::V lost = forces.bones.damping_power - dot<L>(forces.bones.damping, middle) -
                       dot<L>(forces.damping, middle);
  typename L::V power = forces.bones.power;
  if (step.rigid.rate > 0) {
    const Braking<L>& rigid = forces.rigid;
    lost = lost + (rigid.power - dot<L>(rigid.force, middle));
    power = power + rigid.of_bones;
    add_to<L>(sums.driven_power + lane, rigid.power - rigid.of_bones);
  }
  add_to<L>(sums.power + lane, power);
  add_to<L>(sums.lost + lane, lost);
  if (step.fibers.count > 0) add_to<L>(sums.driven_power + lane, dot<L>(forces.muscle, middle));
  if (is_loaded(step.loads, block)) {
    const auto i = static_cast<std::ptrdiff_t>(block) * Traits<typename L::Real>::block + lane;
    add_to<L>(sums.driven_power + lane, dot<L>(load<L>(step.loads.acceleration, i), middle));
  }
}

template <class L>
SINEW_INLINE typename L::V length(const Triple<L>& vector) {
  return L::root(dot<L>(vector, vector));
}

/// What tells a relaxation how far from equilibrium the body is.
template <class L>
SINEW_INLINE void account_of_relaxing(const Step<typename L::Real>& step, std::size_t block,
                                      int lane, const Forces<L>& forces, const Triple<L>& velocity,
                                      Sums<L>& sums) {
  typename L::V live = live_lanes<L>(step.blocks, step.live, block, lane);
  if (step.mass != nullptr)
    live =
        live * L::load(step.mass +
                       static_cast<std::ptrdiff_t>(block) * Traits<typename L::Real>::block + lane);
  const Triple<L>& a = forces.acceleration;
  add_to<L>(sums.aa + lane, live * dot<L>(a, a));
  add_to<L>(sums.av + lane, live * dot<L>(a, velocity));
  add_to<L>(sums.vv + lane, live * dot<L>(velocity, velocity));
  add_to<L>(sums.unbalanced + lane, live * length<L>(a));
  const typename L::V pulled = length<L>(forces.bones.spring) + length<L>(forces.muscle);
  add_to<L>(sums.pulled + lane, live_lanes<L>(step.blocks, step.live, block, lane) * pulled);
}

/// The squared speed relative to a subpiece's motion.
template <class L>
SINEW_INLINE typename L::V relative_speed2(const RigidMotion<typename L::Real>& motion,
                                           const Place<L>& here, const Triple<L>& drifting) {
  const Place<L> center{L::all_coord(motion.center[0]), L::all_coord(motion.center[1]),
                        L::all_coord(motion.center[2])};
  const Triple<L> arm = offset<L>(here, center);
  const Triple<L> relative =
      drifting - all<L>(motion.velocity) - cross<L>(all<L>(motion.spin), arm);
  return dot<L>(relative, relative);
}

/// The largest speed relative to the motion of the piece's first subpiece.
template <class L>
SINEW_INLINE void track_fastest(const Step<typename L::Real>& step, std::size_t block, int lane,
                                const Place<L>& here, const Triple<L>& drifting, Sums<L>& sums) {
  const typename L::V live = live_lanes<L>(step.blocks, step.live, block, lane);
  const typename L::V speed2 =
      live * relative_speed2<L>(step.subpieces.motions[sums.subpiece], here, drifting);
  L::store(sums.fastest + lane, L::larger(speed2, L::load(sums.fastest + lane)));
  if constexpr (sizeof(typename L::Real) == 4)
    L::store(sums.speed2 + lane,
             L::larger(live * dot<L>(drifting, drifting), L::load(sums.speed2 + lane)));
}

template <class L>
SINEW_INLINE void check_speed(const Step<typename L::Real>& step, const Triple<L>& kicked,
                              const Triple<L>& carried, Sums<L>& sums) {
  const Triple<L> relative = kicked - carried;
  const typename L::V speed2 = dot<L>(relative, relative);
  sums.sound = sums.sound && L::every(L::at_most(speed2, L::all(step.most)));
}

template <class L, PairLaw pairs, Pass pass>
SINEW_INLINE void advance(const Step<typename L::Real>& step, const LawOf<L, pairs>& law,
                          std::size_t block, int lane, Sums<L>& sums) {
  const std::ptrdiff_t i =
      static_cast<std::ptrdiff_t>(block) * Traits<typename L::Real>::block + lane;
  const Place<L> here = load_place<L>(step.before.x, i);
  const Triple<L> velocity = load<L>(step.before.v, i);
  const bool touched = is_touched(step.surroundings, block);
  const Forces<L> forces =
      touched && !step.surroundings.finding
          ? kept<L>(step, row_of<L>(block, lane), velocity)
          : forces_on<L, pairs, pass, false>(step, law, block, lane, here, velocity);
  if (touched && step.surroundings.finding) return keep<L>(step, row_of<L>(block, lane), forces);
  gather_if_grouped<L>(step.grouped, block, lane, forces.acceleration);
  const Triple<L> kicked =
      fused<L>(L::all(step.kick), forces.acceleration, L::all(step.keep) * velocity);
  const Triple<L> drifting = step.drift_first ? velocity : kicked;
  const Triple<L> by = L::all(step.drift) * drifting;
  store<L>(step.after.v, i, kicked);
  L::store_coord(step.after.x[0] + i, L::moved(here.x, by.x));
  L::store_coord(step.after.x[1] + i, L::moved(here.y, by.y));
  L::store_coord(step.after.x[2] + i, L::moved(here.z, by.z));
  account<L>(step, forces, velocity, block, lane, sums);
  if (step.relaxes) account_of_relaxing<L>(step, block, lane, forces, velocity, sums);
  check_speed<L>(step, kicked, forces.bones.carried, sums);
  if (step.grouped.role == nullptr || step.grouped.whole[block] == 0)
    track_fastest<L>(step, block, lane, here, drifting, sums);
  if constexpr (pairs == changing_springs) {
    if (step.bonds.branches_flow) {
      relax_bonds<L, nearest>(step, block, lane, sums.lost + lane);
      relax_bonds<L, second>(step, block, lane, sums.lost + lane);
    }
    if (forces.strained) [[unlikely]] {
      change_bonds<L, nearest>(step, block, lane, sums.lost + lane, sums.broke);
      change_bonds<L, second>(step, block, lane, sums.lost + lane, sums.broke);
    }
  }
}

template <class L, PairLaw pairs, Pass pass>
SINEW_INLINE void probe_vector(const Step<typename L::Real>& step, const LawOf<L, pairs>& law,
                               std::size_t block, int lane, Sums<L>& sums) {
  const std::ptrdiff_t i =
      static_cast<std::ptrdiff_t>(block) * Traits<typename L::Real>::block + lane;
  const Place<L> here = load_place<L>(step.before.x, i);
  const Triple<L> velocity = load<L>(step.before.v, i);
  const bool touched = is_touched(step.surroundings, block);
  const Forces<L> forces =
      touched && !step.surroundings.finding
          ? kept<L>(step, row_of<L>(block, lane), velocity)
          : forces_on<L, pairs, pass, true>(step, law, block, lane, here, velocity);
  if (touched && step.surroundings.finding) return keep<L>(step, row_of<L>(block, lane), forces);
  const std::ptrdiff_t to = i - step.probed.first;
  store<L>(step.probed.pair, to, forces.pairs.force);
  store<L>(step.probed.damping, to, forces.damping + forces.rigid.force);
  store<L>(step.probed.bone, to, forces.bones.spring + forces.bones.damping);
  if (step.probed.muscle[0] != nullptr) store<L>(step.probed.muscle, to, forces.muscle);
  typename L::Real count[L::width];
  L::store(count, forces.pairs.count);
  for (int k = 0; k < L::width; ++k)
    step.probed.neighbors[to + k] = static_cast<std::int32_t>(count[k]);
  add_to<L>(sums.pair_energy + lane, forces.pairs.energy);
  add_to<L>(sums.bone_energy + lane, forces.bones.energy);
  account<L>(step, forces, velocity, block, lane, sums);
}

template <class L>
SINEW_INLINE Totals totals_of(const Sums<L>& sums) {
  typename L::Real speed2 = 0;
  for (const typename L::Real one : sums.speed2) speed2 = one > speed2 ? one : speed2;
  return {sum_of<L>(sums.power),
          sum_of<L>(sums.driven_power),
          sum_of<L>(sums.lost),
          sum_of<L>(sums.pair_energy),
          sum_of<L>(sums.bone_energy),
          static_cast<double>(speed2),
          sums.sound,
          sums.broke,
          {sum_of<L>(sums.aa), sum_of<L>(sums.av), sum_of<L>(sums.vv), sum_of<L>(sums.unbalanced),
           sum_of<L>(sums.pulled)}};
}

/// Finds the largest speeds in subpieces of a piece that has moved, but for blocks of groups alone.
template <class L>
[[gnu::noinline]] void track_subpieces(const Step<typename L::Real>& step, std::uint32_t begin,
                                       std::uint32_t end) {
  const Subpieces<typename L::Real>& subpieces = step.subpieces;
  const auto& drifting = step.drift_first ? step.before.v : step.after.v;
  const auto counts = [&](std::uint32_t k) {
    return step.grouped.role == nullptr ||
           step.grouped.whole[k / Traits<typename L::Real>::block] == 0;
  };
  for (std::uint32_t subpiece = begin; subpiece < end; ++subpiece) {
    typename L::Real fastest = 0, speed2[L::width];
    const std::uint32_t last = subpieces.first[subpiece + 1];
    for (std::uint32_t k = subpieces.first[subpiece]; k < last; k += L::width) {
      L::store(speed2, relative_speed2<L>(subpieces.motions[subpiece],
                                          load_place<L>(step.before.x, k), load<L>(drifting, k)));
      for (std::uint32_t lane = 0; lane < L::width && k + lane < last; ++lane)
        fastest = counts(k + lane) && speed2[lane] > fastest ? speed2[lane] : fastest;
    }
    subpieces.fastest[subpiece] = fastest;
  }
}

/// The largest speeds in a piece that has moved.
template <class L>
SINEW_INLINE void store_fastest(const Step<typename L::Real>& step, std::size_t piece,
                                const Sums<L>& sums) {
  const std::size_t next = (piece + 1) * blocks_per_piece;
  const std::uint32_t end =
      next < step.blocks ? step.subpieces.of_block[next] : step.subpieces.count;
  if (end != sums.subpiece + 1) return track_subpieces<L>(step, sums.subpiece, end);
  typename L::Real& fastest = step.subpieces.fastest[sums.subpiece] = 0;
  for (const typename L::Real one : sums.fastest) fastest = one > fastest ? one : fastest;
}

/// Calls visit(block, lane, sums) for every vector of the pieces but for idle ones, and stores
/// their totals; `moves`: it moves them.
template <class L, bool moves, class Visit>
SINEW_INLINE void for_each_vector(const Step<typename L::Real>& step, std::size_t begin,
                                  std::size_t end, Visit visit) {
  constexpr int block_size = Traits<typename L::Real>::block;
  for (std::size_t piece = begin; piece < end; ++piece) {
    Sums<L> sums;
    if constexpr (moves) sums.subpiece = step.subpieces.of_block[piece * blocks_per_piece];
    const std::size_t first = piece * blocks_per_piece, last = first + blocks_per_piece;
    for (std::size_t block = first; block < last && block < step.blocks; ++block) {
      if (step.grouped.role != nullptr && step.grouped.role[block] == idle) continue;
      if (step.surroundings.finding && !is_touched(step.surroundings, block)) continue;
      for (int lane = 0; lane < block_size; lane += L::width) visit(block, lane, sums);
    }
    if (step.surroundings.finding) continue;
    if constexpr (moves) store_fastest<L>(step, piece, sums);
    step.totals[piece] = totals_of(sums);
  }
}

template <class L, PairLaw pairs, Pass pass>
void step_pieces(const Step<typename L::Real>& step, std::size_t begin, std::size_t end) {
  const LawOf<L, pairs> law = law_of<L, pairs>(step);
  for_each_vector<L, true>(
      step, begin,
      end, [&](std::size_t block, int lane, auto& sums) __attribute__((always_inline)) {
        if constexpr (pairs != changing_springs)  // whose many streams leave no room in the caches
          if (lane == 0) fetch_for_step(step, block);
        advance<L, pairs, pass>(step, law, block, lane, sums);
      });
}

template <class L, PairLaw pairs, Pass pass>
void probe_pieces(const Step<typename L::Real>& step, std::size_t begin, std::size_t end) {
  const LawOf<L, pairs> law = law_of<L, pairs>(step);
  for_each_vector<L, false>(
      step, begin,
      end, [&](std::size_t block, int lane, auto& sums) __attribute__((always_inline)) {
        probe_vector<L, pairs, pass>(step, law, block, lane, sums);
      });
}

/// Finds Step::inverse_count, for pairwise damping.
template <class L, PairLaw pairs>
void count_pieces(const Step<typename L::Real>& step, std::size_t begin, std::size_t end) {
  constexpr int size = Traits<typename L::Real>::block;
  const LawOf<L, pairs> law = law_of<L, pairs>(step);
  const std::size_t last = end * blocks_per_piece;
  for (std::size_t block = begin * blocks_per_piece; block < last && block < step.blocks; ++block) {
    if (step.grouped.inactive != nullptr && step.grouped.inactive[block] != 0) continue;
    for (int lane = 0; lane < size; lane += L::width) {
      bool strained = false;
      const typename L::V count =
          sums_of<L, pairs, counts, false>(step, law, block, lane, strained).count;
      const auto some = L::less(L::all(0), count);
      L::store(step.inverse_count + static_cast<std::ptrdiff_t>(block) * size + lane,
               L::keep(some, L::all(1) / L::larger(count, L::all(1))));
    }
  }
}

}  // namespace sinew::kernel
