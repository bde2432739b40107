// SPDX-License-Identifier: GPL-3.0-or-later
// The work of a time step on plain arrays, compiled once per instruction set and chosen when the
// program runs: the same bits for all of them and for any split of the blocks among threads.
//
// Particles stand in blocks of as many as a 64-byte vector holds. A block's list names the distinct
// differences j - i of all its pairs within reach: the partners of its lanes for one difference lie
// side by side in memory, so they are loaded without an index, and their distance tells which of
// them count. Each pair (i, j) has one difference, hence every pair within the range counts once,
// partners in ascending order. Pads of one block at both ends hold particles that are nobody's.
//
// Plain pointers and no library's types: the sources that include this are compiled with flags of
// their own, under which an inline function of another header would be a trap for the linker.
// Quantities are per unit of mass.
#pragma once

#include <cstddef>
#include <cstdint>

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

/// Blocks whose sums are kept together, and that one thread takes.
inline constexpr std::size_t blocks_per_piece = 32;

/// Positions and velocities, to be read one block beyond both ends. One unit of coordinates is the
/// kernel's length.
template <class Real>
struct State {
  using Coord = typename Traits<Real>::Coord;
  Coord* x[3];
  Real* v[3];
};

/// Lists of all blocks: block k has the values [first[k], first[k + 1]) of `value`.
struct Lists {
  const std::uint32_t* first;
  const std::int32_t* value;
};

/// Eq. 1 and eq. 2. A pair force is k (...) times the difference of coordinates, by the distance.
template <class Real>
struct Law {
  Real r, a, b, b2;  ///< lengths; b squared
  Real k1, k2;       ///< per r: forces of eq. 1 for lengths in radii
  Real damping;
};

/// A rigid frame: in it a particle has the coordinates axes (x - center).
template <class Real>
struct FrameNow {
  typename Traits<Real>::Coord center[3];
  Real rest_of_center[3];  ///< what whole numbers leave of it
  Real axes[9];
  Real velocity[3], spin[3];  ///< of the center; angular
};

/// A bone, where it is, and its springs. The first axis of its frame points along it.
template <class Real>
struct BoneNow {
  FrameNow<Real> frame;
  Real radial, twist, axial, damping;
};

/// A bone's hold on a block. Its lanes' numbers stand in `held`, field after field.
struct Slot {
  std::int32_t bone;
  std::int32_t shares;  ///< whose weights, or -1: all lanes are held by this bone alone
};

/// Fields of `held`, in the bone's frame at rest: foot and place along the bone, place across it
/// (0 for a particle on the axis), distance from the foot.
enum HeldField { foot, along, across_1, across_2, distance, held_fields };
/// Fields of `shares`: weight of the bone; 1 where no bone weighs more, else 0.
enum ShareField { weight, lead, share_fields };

template <class Real>
struct Holds {
  const std::uint32_t* first;  ///< slots of block k: [first[k], first[k + 1])
  const Slot* slots;
  const Real* held;    ///< slots x held_fields x block
  const Real* shares;  ///< x share_fields x block
  const BoneNow<Real>* bones;
};

/// The frames that carry a block's particles along, each particle by one.
struct FrameSlot {
  std::int32_t frame;
  std::int32_t lanes;  ///< whose ones, or -1: all lanes are this frame's
};

template <class Real>
struct ComovingFrames {
  const std::uint32_t* first;  ///< slots of block k: [first[k], first[k + 1])
  const FrameSlot* slots;
  const Real* lanes;  ///< x block; 1 where the frame carries the particle, else 0
  const FrameNow<Real>* frames;
};

/// What a piece adds up to.
struct Totals {
  double power;        ///< of the bones
  double lost;         ///< what the step dissipates per time
  double pair_energy;  ///< only from probe
  double bone_energy;  ///< only from probe
  double fastest;      ///< largest squared speed relative to the comoving_frame
  bool sound;          ///< none too fast (see most_radii_per_step), all values finite
};

/// Forces of a probe, by particle.
template <class Real>
struct Probed {
  Real* pair[3];
  Real* damping[3];
  Real* bone[3];
  std::int32_t* partners;
};

template <class Real>
struct Step {
  State<Real> before, after;
  std::size_t blocks;
  const std::int32_t* id;
  Lists lists;
  Holds<Real> holds;
  ComovingFrames<Real> comoving_frames;
  Law<Real> law;
  Real unit;         ///< length of one unit of coordinates
  Real gravity[3];   ///< per time squared
  Real kick;         ///< v += kick a
  Real drift;        ///< x += drift v, in units of coordinates
  Real middle;       ///< velocities are told at v + middle a
  bool drift_first;  ///< x moves with the old velocity (explicit Euler)
  Real most;         ///< squared speed relative to the leading bone that is still sound
  Totals* totals;    ///< by piece
  Probed<Real> probed;
};

/// Where particles are in the frames that carry them, beside where they were at a moment of
/// reference: a body that moves along with them stands still there.
template <class Real>
struct FrameDrift {
  State<Real> state;
  ComovingFrames<Real> comoving_frames;
  float* reference[3];
};

/// Prunes the differences of a block's candidates.
template <class Real>
struct PruneInput {
  State<Real> state;
  Real range2;  ///< squared distance
};

/// The functions of one instruction set.
template <class Real>
struct Functions {
  /// Advances the blocks of the pieces [begin, end).
  void (*step)(const Step<Real>&, std::size_t begin, std::size_t end);
  /// Fills `probed` and all of `totals`, moves nothing.
  void (*probe)(const Step<Real>&, std::size_t begin, std::size_t end);
  /// Copies the differences in [from, to) with a pair of the block within range; returns the end.
  std::int32_t* (*prune_range)(const PruneInput<Real>&, std::size_t block, std::int64_t from,
                               std::int64_t to, std::int32_t* kept);
  /// The same of a list of differences.
  std::int32_t* (*prune)(const PruneInput<Real>&, std::size_t block, const std::int32_t* begin,
                         const std::int32_t* end, std::int32_t* kept);
  /// Writes the reference of the blocks [begin, end).
  void (*remember)(const FrameDrift<Real>&, std::size_t begin, std::size_t end);
  /// Their largest squared distance from it.
  Real (*displacement)(const FrameDrift<Real>&, std::size_t begin, std::size_t end);
};

enum class InstructionSet { plain, sse2, avx2, avx512 };

/// The best this processor has.
InstructionSet best_instruction_set();
/// Whether this processor and this build have it.
bool has(InstructionSet set);
const char* name_of(InstructionSet set);

template <class Real>
Functions<Real> functions_of(InstructionSet set);

}  // namespace sinew::kernel
