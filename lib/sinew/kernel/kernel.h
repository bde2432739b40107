// SPDX-License-Identifier: GPL-3.0-or-later
// The work of a time step on plain arrays, compiled once per instruction set and chosen at run
// time: the same bits for all of them and for any split of the blocks among threads.
//
// Particles are stored in blocks of as many as a 64-byte vector holds. A block's list has the
// distinct differences j - i of all its pairs within range: for one difference, the neighbors of
// its lanes are contiguous in memory, so they are loaded without an index, and their distance
// decides which of them count. Each pair (i, j) has one difference, hence every pair within the
// range counts once, neighbors in ascending order. A block of padding particles at each end may be
// read.
//
// Plain pointers and no library types: the sources that include this are compiled with flags of
// their own, and the linker might pick their version of another header's inline function.
// Quantities are per unit of mass.
#pragma once

#include <cstddef>
#include <cstdint>

#include <sinew/kernel/bond_arrays.h>
#include <sinew/kernel/group_arrays.h>
#include <sinew/kernel/instruction_set.h>
#include <sinew/kernel/strain_arrays.h>

namespace sinew::kernel {

template <class Real>
struct Traits;
template <>
struct Traits<double> {
  using Coord = double;
  static constexpr int block = 8;
};
template <>
struct Traits<float> {
  using Coord = std::int32_t;
  static constexpr int block = 16;
};

template <class Real>
using Coord = typename Traits<Real>::Coord;

/// Blocks whose sums are accumulated together, by one thread.
inline constexpr std::size_t blocks_per_piece = 32;

/// Positions and velocities, readable one block beyond both ends. Coordinates are in units of the
/// kernel's length.
template <class Real>
struct State {
  Coord<Real>* x[3];
  Real* v[3];
};

/// Lists of a piece's blocks: its block k has the values [first[k], first[k + 1]) of `value`.
struct Lists {
  const std::uint32_t* first;
  const std::int32_t* value;
  const std::uint16_t* lanes;  ///< lanes that each difference is for; null: all
};

/// What acts between pairs: eq. 1 between all; eq. 1, without its attraction between particles that
/// were no neighbors at rest; springs between neighbors at rest and the repulsion of eq. 1 between
/// others; the same with springs that creep, relax and break.
/// A law of one's own has a number from pair_laws on, and a BondForce (bonds.h).
/// The last: eq. 1 between those of all that lists give lanes.
enum PairLaw : int {
  between_all,
  among_neighbors,
  springs,
  changing_springs,
  between_listed,
  pair_laws
};
/// Whether neighbors at rest are bonds, whose far ends need lists of stiffness and length.
constexpr bool is_bonded(PairLaw law) {
  return law != between_all && law != among_neighbors && law != between_listed;
}
/// Whether it is eq. 1 whatever was near at rest.
constexpr bool has_no_memory(PairLaw law) { return law == between_all || law == between_listed; }

/// Eq. 2 towards the mean velocity of the neighbors; or pair by pair, with the mean of both
/// particles' inverse counts of neighbors.
enum Damping { to_the_mean, pairwise, dampings };

/// Eq. 1 and eq. 2. A pair force is k (...) times the difference of coordinates, over the distance.
template <class Real>
struct Law {
  Real r, a, b, b2;  ///< lengths; b squared
  Real k1, k2;       ///< per r: forces of eq. 1 for lengths in radii
  Real damping;
};

/// A rigid frame: a particle at x has the coordinates axes (x - center) in it.
template <class Real>
struct FrameNow {
  Coord<Real> center[3];
  Real rest_of_center[3];  ///< remainder of the fixed-point center
  Real axes[9];
  Real velocity[3], spin[3];  ///< velocity of the center; angular velocity
};

/// How a bone pulls: with springs about its axis, the twist as a servo or in open loop; or each
/// particle to its place.
enum BonePulls { servo, open_loop, anchor };

/// A bone at the present moment, and its springs. The first axis of its frame points along it.
template <class Real>
struct BoneNow {
  FrameNow<Real> frame;
  Real radial, twist, axial, damping;
  Real yield;  ///< twice the energy beyond which they yield; 0: they never do
  BonePulls pulls;
  Real turning;       ///< twist times the angle, in open loop
  Real center;        ///< center of the frame, along the bone at rest
  Real stretch;       ///< factor of lengths along the bone
  Real stretch_rate;  ///< per time
};

/// A bone to which particles of a block are bound. Its lanes' fields are in `attachments`, field
/// after field.
struct Slot {
  std::int32_t bone;
  std::int32_t weights;  ///< place of its weights, or -1: all lanes are bound to this bone alone
};

/// Fields of `attachments`, in the bone's frame at rest: foot and position along the bone, position
/// across it (0 for a particle on the axis), distance from the foot.
enum AttachmentField { foot, along, across_1, across_2, distance, attachment_fields };
/// Fields of `weights`: weight of the bone; 1 where no bone weighs more, else 0.
enum WeightField { weight, lead, weight_fields };

/// The bones to which the particles of each block are bound.
template <class Real>
struct Bindings {
  const std::uint32_t* first;  ///< slots of block k: [first[k], first[k + 1])
  const Slot* slots;
  const Real* attachments;  ///< slots x attachment_fields x block
  const Real* weights;      ///< x weight_fields x block
  const BoneNow<Real>* bones;
};

/// The velocity field of what moves as a rigid body: velocity + spin x (x - center).
template <class Real>
struct RigidMotion {
  Coord<Real> center[3];
  Real velocity[3], spin[3];
};

/// What particles move with: velocity + gradient (x - center).
template <class Real>
struct AffineMotion {
  Coord<Real> center[3];
  Real velocity[3], gradient[9];  ///< row by row
  Real of_bones;                  ///< 1: its power is the bones', 0: of what else drives the body
};

/// Damping of each particle relative to a mean of such motions.
template <class Real>
struct RigidDamping {
  Real rate;                   ///< 0: there is none
  const std::uint32_t* first;  ///< slots of block k: [first[k], first[k + 1])
  const Slot* slots;           ///< whose `bone` is a motion
  const Real* weights;         ///< slots x block
  const AffineMotion<Real>* motions;
};

/// Subpieces move on their own: consecutive particles of a piece. A piece begins with one.
template <class Real>
struct Subpieces {
  const std::uint32_t* first;     ///< particle of each; one longer, ends with the last particle
  const std::uint32_t* of_block;  ///< subpiece of its first particle
  std::uint32_t count;
  const RigidMotion<Real>* motions;
  Real* fastest;  ///< becomes the largest squared speed relative to the motion
};

/// What a step that relaxes tells of its particles, at the positions that it began with: sums of
/// a . a, a . v and v . v, of the lengths of a, and of those of the forces of bones and fibers.
struct Relaxing {
  double aa, av, vv;
  double unbalanced, pulled;
};

/// Sums of a piece.
struct Totals {
  double power;         ///< power of the bones
  double driven_power;  ///< power of muscles and loads
  double lost;          ///< what the step dissipates per time
  double pair_energy;   ///< only from probe
  double bone_energy;   ///< only from probe
  double speed2;        ///< the largest squared speed, of what steps store as fixed point
  bool sound;           ///< none too fast (see max_radii_per_step), all values finite
  bool broke;           ///< a bond
  Relaxing relaxing;    ///< only of steps that relax
};

/// Forces of a probe, by particle from `first` on.
template <class Real>
struct Probed {
  std::ptrdiff_t first;
  Real* pair[3];
  Real* damping[3];
  Real* bone[3];
  Real* muscle[3];  ///< null without muscles
  std::int32_t* neighbors;
};

/// Accelerations by loads.
template <class Real>
struct Loads {
  const std::uint8_t* on;  ///< one per block: whether it has some; null: there are none
  const Real* acceleration[3];
};

/// What surrounds the body acts on the blocks that it may touch when all other forces on them are
/// known. A piece with such blocks takes two calls: one finds the forces on these alone and keeps
/// them, whoever calls changes their accelerations, the other makes the step with what is kept.
/// Rows are those of a piece: block after block, `block` of each.
template <class Real>
struct Surroundings {
  const std::uint8_t* touched;  ///< one per block of the body; null: there is nothing
  bool finding;                 ///< the first of the two calls
  Real* acceleration[3];        ///< rows: found, then what it has become
  const Real* held;             ///< rows: 1 for what pins hold, else 0
  void* forces;                 ///< room for what is kept, of Functions::kept bytes
};

/// Particles that move in groups: see groups/groups.h. What a block's role is unless it has a
/// row of accelerations.
enum Role : std::int32_t { working = -1, idle = -2 };

template <class Real>
struct Grouped {
  /// One per block: working, idle (a step leaves it out) or a row; null: working.
  const std::int32_t* role;
  const std::uint8_t* inactive;  ///< one per block: nobody needs its deformation or its counts
  const std::uint8_t* whole;     ///< one per block: all of it is grouped, whose speeds are known
  Real* acceleration[3];         ///< rows x block
};

/// Particles [begin, end) of a group, to be put where its motion brings them.
template <class Real>
struct PutInput {
  State<Real> state;
  std::size_t begin, end;
  const double* at[3];  ///< places of all particles in their groups' frames
  const double* x;      ///< coefficients, axis by axis cubic_terms long, in units of the kernel
  const double* v;
};

template <class Real>
struct Step {
  State<Real> before, after;
  std::size_t blocks;
  const std::int32_t* id;
  const Real* live;    ///< lanes of the last block: 1 for a particle, 0 for padding
  const Lists* lists;  ///< one per piece
  Subpieces<Real> subpieces;
  Bindings<Real> bindings;
  RigidDamping<Real> rigid;
  Law<Real> law;
  std::uint8_t* careful;  ///< one per vector: pairs needed care in the last step; double precision
  Real* inverse_count;    ///< 1 / neighbors, or 0; of pairwise damping
  bool central;           ///< damping acts along the pair alone
  Bonds<Real> bonds;      ///< bonds of laws that know neighbors at rest, and of fibers
  Real* inverse[6];       ///< inverse of the sum of X X^T at rest: x x, y y, z z, y z, z x, x y
  Volumes<Real> volumes;
  Fibers<Real> fibers;
  Loads<Real> loads;
  Surroundings<Real> surroundings;
  Grouped<Real> grouped;
  const Real* mass;  ///< mass of each particle that forces are per; null: 1 each
  Real gravity[3];   ///< per time squared
  Real keep;         ///< v = keep v + kick a; 1 but where a step relaxes
  Real kick;
  Real drift;        ///< x += drift v, in units of coordinates
  Real middle;       ///< the ledger uses the velocity v + middle a
  bool drift_first;  ///< x moves with the old velocity (explicit Euler)
  bool relaxes;      ///< fills Totals::relaxing
  Real most;         ///< largest valid squared speed relative to the leading bone
  Totals* totals;    ///< one per piece
  Probed<Real> probed;
};

/// Sums over particles that determine their motion and extent, with coordinates x relative to one
/// of them.
struct Survey {
  double low[3], high[3];              ///< bounds of x
  double low_along[3], high_along[3];  ///< bounds of x along each of some axes
  double x[3], v[3];
  double xx[6];  ///< x x, y y, z z, y z, z x, x y
  double xv[3];  ///< x cross v
};

template <class Real>
struct SurveyInput {
  State<Real> state;
  std::size_t begin, end;  ///< particles
  Real axes[3][3];         ///< one after another
};

/// Axes of bounds: x, y, z, then the diagonals between each two of them, which bound rows of a
/// lattice closely wherever they turn.
inline constexpr int bound_axes = 9;

/// Around the particles of each block of a piece, in lengths of the kernel; of blocks that the body
/// does not have, infinite, the least above the largest.
struct BlockBounds {
  float low[bound_axes][blocks_per_piece], high[bound_axes][blocks_per_piece];
};

/// Input of a piece's lists: the pieces near it, ascending, itself included.
template <class Real>
struct ListInput {
  State<Real> state;
  const std::uint32_t* pieces;
  std::size_t count;
  std::size_t own;            ///< number of its own piece among these
  const BlockBounds* bounds;  ///< one per piece of the body
  const BlockBounds* around;  ///< bounds as if each of those near were a block
  float range;
  Coord<Real> center[3];  ///< a place within the piece
  /// Room for the places of particles from the center, by block of the pieces near it, as four
  /// fields of floats, and whether they have been found.
  float* places;
  std::uint8_t* placed;
};

/// A block near one or both of two, counted from the first of the pieces near theirs; the bits of
/// `of` tell near which.
struct NearBlock {
  std::uint32_t which, of;
};

/// Prunes the differences of a block's candidates: those with a pair within range are kept.
template <class Real>
struct PruneInput {
  State<Real> state;
  Real range2;  ///< squared distance
};

/// Particles [begin, end) whose momenta are summed up.
template <class Real>
struct MomentaInput {
  State<Real> state;
  std::size_t begin, end;
  double length, speed;  ///< units of the state
  double shift[3];       ///< to be added to positions, in the unit of the sums
  const double* mass;    ///< one per particle; null: 1
};
/// Mass, first and second moments (xx yy zz yz zx xy), momentum and angular momentum.
inline constexpr int momenta = 16;

/// Differences and, unless null, the lanes that each is for.
struct Candidates {
  std::int32_t* value;
  std::uint16_t* lanes;
  std::size_t count;  ///< to be read, not of room
};

/// On the pieces [begin, end).
template <class Real>
using Work = void (*)(const Step<Real>&, std::size_t begin, std::size_t end);

/// The functions of one law.
template <class Real>
struct LawFunctions {
  /// Finds the shares that pairwise damping needs, before a step.
  Work<Real> count;
  /// Advances the blocks of the pieces.
  Work<Real> step[dampings];
  /// The same: fills `probed` and all of `totals`; moves nothing.
  Work<Real> probe[dampings];
};

/// A law that a program brings, of bonds that keep their lengths: see ForceLaw::kernel.
struct OwnLaw {
  LawFunctions<double> in_double;
  LawFunctions<float> in_single;  ///< or none

  template <class Real>
  const LawFunctions<Real>& in() const {
    if constexpr (sizeof(Real) == sizeof(double))
      return in_double;
    else
      return in_single;
  }
};

/// The functions of one instruction set.
template <class Real>
struct Functions {
  /// Finds the thrusts of volumes and fibers, which must be known everywhere before a step.
  Work<Real> flow;  ///< work of bonds that creep
  Work<Real> strain;
  LawFunctions<Real> law[pair_laws];
  /// Bytes that Surroundings::forces takes, at 64 byte boundaries.
  std::size_t kept;
  /// Functions of groups, by motions: places and velocities; sums of forces; what bones exert.
  void (*put[motions])(const PutInput<Real>&);
  /// The largest squared length of a field at the particles.
  double (*largest[motions])(const FieldInput&);
  void (*moments[motions])(const MomentInput<Real>&, TermSums&);
  void (*pull[motions])(const Step<Real>&, const PulledBlocks<Real>&, PullSums&);
  /// What bonds exert on their far ends, over their stiffness: sums times the square terms of the
  /// near ends, axis by axis square_terms long; and times all of their terms.
  void (*pull_bonds)(const GroupBonds&, double* sums);
  void (*pull_ends)(const GroupBonds&, double* sums);
  /// Bounds the blocks of a piece, of a body of so many particles.
  void (*bound)(const State<Real>&, std::size_t piece, std::size_t particles, BlockBounds&);
  /// Finds differences of a block, which is of even number, and of the next one, if there is one;
  /// ascending: all that have a pair within range, and few others, barely beyond it. `near`: room
  /// for all blocks of the pieces; `found`: each for twice as many particles; `counts`: how many.
  void (*list)(const ListInput<Real>&, std::size_t block, NearBlock* near,
               std::int32_t* const found[2], std::size_t counts[2]);
  /// Keeps the differences with a pair within range; returns how many.
  std::size_t (*prune)(const PruneInput<Real>&, std::size_t block, const Candidates& from,
                       const Candidates& kept);
  /// Sums up the momenta; in double precision.
  void (*momenta)(const MomentaInput<Real>&, double* sums);
  /// Surveys particles relative to `center`.
  Survey (*survey)(const SurveyInput<Real>&, const Coord<Real>* center);
};

template <class Real>
Functions<Real> functions_of(InstructionSet set);

// Functions of each set of instructions, made by kernel.cpp.
extern const Functions<double> doubles_plain;
extern const Functions<float> floats_plain;
#if defined(__x86_64__)
extern const Functions<double> doubles_avx2, doubles_avx512;
extern const Functions<float> floats_avx2, floats_avx512;
#endif

}  // namespace sinew::kernel
