// SPDX-License-Identifier: GPL-3.0-or-later
// Brings a body to rest at one moment after another, by dynamic relaxation: it moves as if damped
// in proportion to its mass, critically for the mode that moves most at present. Steps are those
// of the kernel, with a velocity that keeps (2 - c h) / (2 + c h) of itself; c = 2 w, with w^2 the
// Rayleigh quotient of the motion, -v.(a_n - a_(n-1)) / (h v.v). (Underwood, Dynamic relaxation,
// in: Computational Methods for Transient Analysis, 1983; Papadrakakis, 1981.)
//
//     Relaxation relaxation(load_steps, relaxation_of(body, stepper, step));
//     while (!relaxation.done()) {
//       relaxation.begin_iteration();
//       relaxation.iterate(stepper, moment_at(relaxation.time()), offenders);
//     }
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <sinew/body/body.h>
#include <sinew/core/options.h>
#include <sinew/core/simulation_state.h>
#include <sinew/stepping/stepper.h>

namespace sinew {

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
  std::int64_t newton = 0;      ///< iterations among these that are Newton's; -1: it led nowhere
  std::int64_t negative = 0;    ///< pivots at most, of the factors of the increment
  std::int64_t unstable = 0;    ///< equilibria found on that way from which the body would buckle
};

/// Name of its part in states.
inline constexpr std::string_view rest_part = "way to rest";

template <class Archive>
void serialize(Archive& archive, RelaxationState& state) {
  archive("at_rest", state.at_rest);
  archive("iterations", state.iterations);
  archive("spent", state.spent);
  archive("increments", state.increments);
  archive("reached", state.reached);
  archive("increment", state.increment);
  archive("shortened", state.shortened);
  archive("damping", state.damping);
  archive("pushed", state.pushed);
  archive("largest", state.largest);
  archive("applied", state.applied);
  archive("unbalanced", state.unbalanced);
  archive("best", state.best);
  archive("best_at", state.best_at);
  archive("newton", state.newton);
  archive("negative", state.negative);
  archive("unstable", state.unstable);
}

inline RelaxationState relaxation_in(const SimulationState& state) {
  return part_of<RelaxationState>(state, rest_part);
}

/// Nonzeros of a factor up to which it fits into memory with ease.
inline constexpr double max_factor = 5e7;

/// What an equilibrium of a body costs, foreseen by its shape and bonds alone.
struct StaticCost {
  /// Nonzeros of the factor of its tangent, by symbolic analysis; of a body that is too large for
  /// that, an upper bound beyond max_factor.
  double nonzeros = 0;
  double newton = std::numeric_limits<double>::infinity();  ///< its time by Newton's method, s
  double relaxation = 0;  ///< time by relaxation, s: both of one core of some 2.5 GHz
  double iterations = 0;  ///< iterations of a relaxation, for a body that is held at one end
};
/// Foresees it for a body that is brought to this `residual`, without the factor.
StaticCost relaxation_cost(const Body& body, double residual);
/// Adds the factor, by an analysis that takes a while.
StaticCost with_factor(StaticCost cost, const Body& body);

/// When a body is to be at rest: at 0 and then every `interval`; the last may come sooner.
struct LoadSteps {
  double interval = 0;     ///< s
  int count = 1;           ///< moments, that at 0 included
  double residual = 1e-6;  ///< forces that nothing answers, over the largest of those applied
  std::int64_t max_iterations = 200'000;  ///< for each moment
  /// Before each moment, how many iterations bones and surroundings take to get there from the one
  /// before; none: one each.
  std::vector<int> ramp = {};
  int min_ramp = 1;  ///< iterations for a part of that way, where the whole takes as many
  /// A residual that rounding may leave where it hides the one above; 0: none.
  double acceptable = 0;
  double last = 1;  ///< the length of the last interval, in whole ones
  StaticSolver solver = StaticSolver::relaxation;  ///< automatic, newton: where that applies
  StaticCost cost = {};                            ///< foreseen, for who chose it
};

/// The largest step of a relaxation over the step limit: bent bodies rattle beyond.
inline constexpr double relaxing_step_factor = 0.8;

/// The body without what resists motion alone: its own damping, that of bones and of a medium, and
/// branches, which have relaxed; and in a world in which everything stands still at each moment.
Body undamped(Body body);

struct Stepping;

/// Why Newton's method does not find the equilibria of a body that is free of damping; "": it does,
/// whatever its factor.
std::string why_not_newton(const Body& body, const Stepping& stepping);
/// How a body came to rest at a moment.
struct Equilibrium {
  std::int64_t iterations = 0;  ///< since the moment before
  std::int64_t increments = 1;  ///< increments of the way from there
  double residual = 0;
  std::size_t inverted = 0;  ///< particles
  /// Unstable equilibria on the way, by negative pivots: the body may buckle this way or another.
  std::int64_t unstable = 0;
  /// Upper bound of the lengths of all forces that nothing answers, N, unless the rounding of
  /// single precision hides them.
  double tolerance = 0;
};

/// How an increment has strained a body.
struct IncrementStrain {
  double strain = 0;         ///< largest change of a pair's length over that length
  std::size_t inverted = 0;  ///< particles that are, after it
};

/// A change of a pair's length, over that length, that leaves no doubt which equilibrium follows
/// which: a bar that is pressed by far more at once may fold instead.
inline constexpr double max_strain_of_increment = 0.05;
/// Times that strain, at which one is given up on the way: there it is not at rest yet.
inline constexpr double strain_while_moving = 3;

/// The pose without its velocities: what relaxes stands still, and so do its bones.
void stop(Pose& pose);

class Relaxation {
 public:
  struct Iteration {
    double step = 0;        ///< the largest, s
    double noise = 0;       ///< what rounding leaves of the forces on all particles, N
    double negligible = 0;  ///< the same in double precision, N
    double radius = 0;      ///< radius of a particle, m
  };
  Relaxation(LoadSteps steps, const Iteration& iteration);

  bool done() const { return now_.at_rest >= steps_.count; }
  void begin_iteration() { ++now_.iterations; }
  /// Whether Newton's method is tried in this increment.
  bool is_direct() const { return steps_.solver != StaticSolver::relaxation && now_.newton >= 0; }
  /// Takes a solution of Newton's, whose factor had so many negative pivots.
  void count_solution(std::int64_t negative);
  /// Whether the residual has not become smaller for long, and a shorter increment may help.
  bool is_stalled() const;
  /// The beginning of the present increment, s.
  double begin_time() const;
  /// The time of the bones and the surroundings in the present iteration; before the first of an
  /// increment where it begins, as the body does; s.
  double time() const;
  double step() const { return step_ * now_.shortened; }  ///< s
  double keep() const;  ///< the fraction of the velocities that it leaves
  /// Whether to look at the strain on the way: where bones and surroundings have just come to the
  /// end of the increment, and after as many iterations again.
  bool strain_is_due() const;
  /// Moments at which the body has been at rest.
  int moments() const { return static_cast<int>(now_.at_rest); }
  /// At the last of them.
  const Equilibrium& last() const { return last_; }
  /// The first increment since this began or was restored at whose end Newton's method saw an
  /// unstable equilibrium and at whose beginning a stable one, s.
  const std::optional<std::array<double, 2>>& buckled() const { return buckled_; }
  /// Forces that nothing answered in the last iteration over the largest applied; 0 where nothing
  /// but rounding acts.
  double residual() const;

  /// What became of an iteration.
  enum class Outcome { moved, at_rest, shortened, failed };
  /// A step of the stepper, whose bones stand still at the moment. Where it is rejected, the
  /// particles in `offenders`, and a shorter step unless it is too short already. Throws what
  /// take() throws.
  Outcome iterate(Stepper& stepper, const TimedPose& still, std::vector<Offender>& offenders);

  /// Goes on to the next increment, or from the moment that is reached, as long as `found` allows.
  void accept(const IncrementStrain& found);
  /// Whether an increment that strained the body so is to be given up for a shorter one; `before`:
  /// particles that were inverted where it began.
  bool is_too_large(const IncrementStrain& found, std::size_t before) const;
  /// Whether the way to the present equilibrium met what is unstable, the one before was not, and a
  /// shorter increment may tell better where that begins.
  bool has_become_unstable() const;
  /// Takes the negative pivots of the equilibrium itself.
  void found_at_rest(std::int64_t negative) { now_.negative = negative; }
  /// Where the increment began, to be tried by a shorter one, given what the longer one `found`.
  RelaxationState shorter(RelaxationState begun, double strain) const;
  /// The same after an increment that led to no stable equilibrium: half of it, or the whole by
  /// relaxation where it is as short as may be.
  RelaxationState otherwise(RelaxationState begun) const;

  /// Takes what the step found. Whether the body is at rest where it began: the step must not be
  /// accepted then. Throws Error (unstable) that says why the residual cannot be reached, or has
  /// not been in the number of iterations.
  bool take(const StepSums& sums);
  /// After a step that was rejected: whether to try again, from a halt, with a shorter step.
  bool shorten();

  const RelaxationState& state() const { return now_; }
  void restore(const RelaxationState& state);

 private:
  int ramp() const;
  bool is_last_increment() const;
  bool may_shorten() const;
  double end() const;
  double time_at(double reached) const;
  double moment(std::int64_t index) const;
  bool judge(const StepSums& sums);
  void find_damping(const Imbalance& sums);
  double reference() const;
  double tolerance() const;
  bool is_at_rest(const Imbalance& sums) const;
  std::string moment_text() const;
  [[noreturn]] void refuse_noise() const;
  [[noreturn]] void give_up() const;

  LoadSteps steps_;
  double step_, noise_, negligible_, radius_;
  RelaxationState now_;
  Equilibrium last_;
  std::optional<std::array<double, 2>> buckled_;
};

/// The iterations of a stepper of the body, with steps of that size (s). Throws bad input for a
/// stepper that relaxes nothing.
Relaxation::Iteration relaxation_of(const Body& body, Stepper& stepper, double step);

}  // namespace sinew
