// SPDX-License-Identifier: GPL-3.0-or-later
// All of a simulation that steps change, to the last bit: from it, a simulation of the same body
// continues as if it had never stopped. Neighbor lists are made again: no bit of positions or
// velocities depends on them.
//
//     const SimulationState state = simulation.save();
//     simulation.restore(state);
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include <sinew/core/error.h>
#include <sinew/core/vector.h>

namespace sinew {

// The ledger of a body's energy, J. Work and dissipation are NaN where the body does not move in
// time, but from one equilibrium to another.

struct Energies {
  double kinetic = 0;
  double pair = 0;           ///< between particles; negative for a body that coheres
  double bone = 0;           ///< in the bones' springs
  double gravity = 0;        ///< -m g.x
  double work_of_bones = 0;  ///< work since the start
  double dissipation = 0;    ///< lost to damping, drag and friction since the start
  double contact = 0;        ///< in the springs of obstacles
  double work_of_world = 0;  ///< work since the start: moving obstacles, pins, fields, muscles

  double stored() const { return kinetic + pair + bone + gravity + contact; }
  double work() const { return work_of_bones + work_of_world; }
};

/// Size of what is left of all forces on a body from outside, and of their moments about its
/// center of mass: nothing where it is in equilibrium. NaN: of a body that moves.
struct Unbalanced {
  double force = std::numeric_limits<double>::quiet_NaN();   ///< N
  double moment = std::numeric_limits<double>::quiet_NaN();  ///< N m
};

/// Work and losses so far, J.
struct LedgerEntries {
  double work = 0, dissipation = 0;
  double power = 0;    ///< at the beginning of the last step, W
  bool begun = false;  ///< whether there was a step
};

/// Calls archive(name, member) for each member, to write or to read it.
template <class Archive, class Ledger>
requires std::is_same_v<std::remove_const_t<Ledger>, LedgerEntries>
void serialize(Archive& archive, Ledger& ledger) {
  archive("work", ledger.work);
  archive("lost", ledger.dissipation);
  archive("power", ledger.power);
  archive("begun", ledger.begun);
}

/// Positions and velocities in a stepper's units.
template <class Coord, class Real>
struct MovingColumns {
  std::array<std::vector<Coord>, 3> x;
  std::array<std::vector<Real>, 3> v;
};
using MovingInDouble = MovingColumns<double, double>;       ///< m from the origin, m/s
using MovingInSingle = MovingColumns<std::int32_t, float>;  ///< lengths and lengths per step

/// The fixed-point units of single precision, and their range; of double precision the origin.
struct FixedPointUnits {
  double length = 1;           ///< m
  Vec3 origin = Vec3::Zero();  ///< m
  Box box;                     ///< around all particles when the units were last checked, m
  double traveled = 0;         ///< upper bound since then, m
};

/// State of a body that is brought to rest at one moment after another.
struct RelaxationState {
  std::int64_t at_rest = 0;     ///< moments at which it has been
  std::int64_t iterations = 0;  ///< in the present increment of the way to the next of them
  std::int64_t spent = 0;       ///< in increments before it, those given up included
  std::int64_t increments = 0;  ///< accepted on that way
  double reached = 0;           ///< fraction of that way where it was at rest last
  double increment = 1;         ///< fraction of it that is tried now
  double shortened = 1;         ///< factor on the step
  double damping = 0;           ///< c, 1/s
  double pushed = 0;            ///< a.v after the last iteration, m^2/s^3
  double largest = 0;           ///< force applied where the body was at rest, N
  double applied = 0;           ///< in the last iteration, N
  double unbalanced = 0;        ///< forces in the last iteration that nothing answered, N
  double best = 0;              ///< the smallest of these that counted as progress, N
  std::int64_t best_at = 0;     ///< the iteration in which it was reached
  std::int64_t newton = 0;      ///< of these iterations, Newton's; -1: it led nowhere
  std::int64_t negative = 0;    ///< pivots at most, of the factors of the increment
  std::int64_t unstable = 0;    ///< equilibria found on that way from which the body would buckle
};

/// State of groups of particles that change as the body moves.
struct RegroupingState {
  std::int64_t times = 0;  ///< how often they have
  double lost = 0;         ///< energy lost by merging, J
  /// Moment (s) from which each bone's joint with its parent counts as still; below 0: it moves.
  std::vector<double> still_since = {};
};

/// Steps of one size since one of them. In memory alone: those of runs follow a plan.
struct EvenSteps {
  std::int64_t from = 0;
  double since = 0, step = 0;  ///< s; step 0: not known
  double made = 0;             ///< the step made last, s
};

/// What limits of the particles' speed, relative to their bones, have taken from a body.
struct LimitedSpeeds {
  std::vector<std::int32_t> in_frame = {};  ///< times of each, by place; empty: none
  std::int64_t times = 0;                   ///< since the start
  double energy = 0;                        ///< lost since then, J; part of the dissipation
  Vec3 impulse = Vec3::Zero();              ///< of their bones on them since then, N s
};

/// State of who takes frames anew in which steps fail.
struct GuardState {
  std::vector<std::int32_t> divided = {};  ///< by two: a frame, by what its steps were divided
  std::int32_t divisor = 1;                ///< of the present frame
  bool lenient = false;                    ///< particles may snap, as long as energies balance
  double residual = 0, turnover = 0;       ///< of the balance when that began, J
};

struct SimulationState {
  std::int64_t steps = 0;
  EvenSteps even;
  std::uint64_t body = 0;  ///< checksum of the body, in memory alone; 0: not known
  LedgerEntries ledger;
  LedgerEntries world_ledger;  ///< of obstacles, fields, muscles and pins
  double held_at_start = 0;    ///< kinetic energy of what pins hold, J
  bool kicked = false;         ///< velocities are half a step behind positions (velocity Verlet)
  std::variant<MovingInDouble, MovingInSingle> moving;
  std::vector<std::uint32_t> order;   ///< each particle's place in the caller's order
  FixedPointUnits fixed_point_units;  ///< of double precision the origin
  double mean_when_sorted = 0;        ///< length of lists above which sorting is tried again
  std::vector<double> rest_length;    ///< of the reference's bonds, m; 0 once broken
  // Lists, where bonds change:
  std::vector<std::uint32_t> bonded_lanes;  ///< by entry of the bond lists
  std::vector<double> creep;                ///< of each whole bond, in lengths of the kernel
  // Branches of bonds: how far their states are ahead, s, in the end; and of each branch the
  // stretches of its dashpots, in lengths of the kernel, of each whole bond (of cells: m, of all).
  std::vector<double> branch_clocks;
  std::vector<double> branch_stretches;
  RelaxationState relaxation = {};
  LimitedSpeeds limited = {};
  GuardState guard = {};
  /// Where the present frame, or increment of a relaxation, began; none: here.
  std::shared_ptr<const SimulationState> begun = {};
  /// Terms of each group: how many, then their coefficients of places (m) and of velocities.
  std::vector<double> groups = {};
  std::vector<std::int32_t> grouping = {};  ///< by particle id, where groups change
  RegroupingState regrouping = {};
  // Springs of friction between particles that touch: whose, and their stretches, m.
  std::vector<std::int32_t> sliding_pairs;  ///< two ids each
  std::vector<double> sliding;              ///< three each
  /// Steps of each pressure, the places of its corners, m, and their motions in a step, m.
  std::vector<double> pressed = {};
  // Where bonds have broken, which particles hang together: a label each, by id, and ends of bonds
  // that had broken when they were found.
  std::vector<std::uint32_t> pieces = {};
  std::int64_t broken_ends = 0;
};

/// The saved state is not one of this stepper, or not valid.
inline Error not_a_state(const std::string& why) {
  return bad_input(
      "the saved state does not fit this body: " + why,
      "restore one that the same scene has saved, or begin the run again with --force");
}

inline bool is_finite(const LedgerEntries& ledger) {
  return std::isfinite(ledger.work) && std::isfinite(ledger.dissipation) &&
         std::isfinite(ledger.power);
}

/// Throws bad input unless the numbers that are of the whole body are valid.
inline void check_totals(const SimulationState& state, std::size_t particles) {
  if (state.steps < 0) throw not_a_state("it has " + std::to_string(state.steps) + " steps");
  if (!is_finite(state.ledger) || !is_finite(state.world_ledger) ||
      !std::isfinite(state.held_at_start))
    throw not_a_state("its energies are not finite");
  const LimitedSpeeds& limited = state.limited;
  if (!std::isfinite(limited.energy) || !limited.impulse.allFinite() ||
      (!limited.in_frame.empty() && limited.in_frame.size() != particles))
    throw not_a_state("what it says of limited speeds is not valid");
}

/// Throws bad input unless there are `particles` positions and velocities, all of them finite.
template <class Coord, class Real>
void check_moving(const MovingColumns<Coord, Real>& moving, std::size_t particles) {
  for (int axis = 0; axis < 3; ++axis) {
    if (moving.x[axis].size() != particles || moving.v[axis].size() != particles)
      throw not_a_state("it is of " + std::to_string(moving.x[axis].size()) + " particles, not " +
                        std::to_string(particles));
    for (std::size_t k = 0; k < particles; ++k)
      if (!std::isfinite(static_cast<double>(moving.x[axis][k])) ||
          !std::isfinite(moving.v[axis][k]))
        throw not_a_state("particle " + std::to_string(k) + " has a value that is not finite");
  }
}

/// Throws bad input unless there are so many branches of bonds, all finite.
inline void check_branches(const SimulationState& state, std::size_t branches) {
  const auto finite = [](const std::vector<double>& values) {
    return std::all_of(values.begin(), values.end(), [](double one) { return std::isfinite(one); });
  };
  if (state.branch_clocks.size() != branches)
    throw not_a_state("its bonds have " + std::to_string(state.branch_clocks.size()) +
                      " branches, not " + std::to_string(branches));
  if (!finite(state.branch_clocks) || !finite(state.branch_stretches))
    throw not_a_state("a branch of a bond has no length");
}
}  // namespace sinew
