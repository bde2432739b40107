// SPDX-License-Identifier: GPL-3.0-or-later
// What the kernel does for groups of particles (groups/groups.h). Plain, as kernel.h says.
#pragma once

#include <cstddef>
#include <cstdint>

namespace sinew::kernel {

/// Groups move by polynomials of the place in their frame: of its terms in the order of
/// groups/cubic/polynomials.h, affine groups have the first ones alone.
inline constexpr int affine_terms = 4, square_terms = 10, cubic_terms = 20;
enum Motions { affine, cubic, motions };

/// Particles of a group, and a polynomial of its motion: the same terms, three values.
struct FieldInput {
  std::size_t begin, end;
  const double* at[3];  ///< places of all particles
  const double* value;  ///< coefficients, axis by axis cubic_terms long
  std::size_t size;     ///< number of all particles, at least a vector's
};

/// Particles of a group that follow each other in memory.
template <class Real>
struct MomentInput {
  const Real* force[3];
  const Real* at[3];
  std::size_t count;
};

/// Blocks of one group, and what each counts.
template <class Real>
struct PulledBlocks {
  const std::uint32_t* block;
  const double* weight;
  std::size_t count;
  const Real* at[3];  ///< places of all particles
};

/// Sums of some vectors times each term of the place, for each axis.
struct TermSums {
  double sum[3 * cubic_terms];  ///< axis by axis cubic_terms long
};

/// What bones exert on them, per mass.
struct PullSums {
  TermSums force;
  TermSums damping;    ///< the part of it that is damping
  double power, lost;  ///< power from the bones; part of it that damping loses
};

/// Bonds of one direction in a group that moves by cubics: particles at its two ends are apart by a
/// square polynomial of the place of the near one.
struct GroupBonds {
  const double* at[3];    ///< places of the near ends
  const double* weight;   ///< on the stiffness
  const double* contact;  ///< on what they exert where they touch
  std::size_t count;      ///< a whole number of vectors of 64 bytes
  const double* apart;    ///< coefficients, axis by axis square_terms long
  double length;          ///< at rest
  double push, touching;  ///< k1 of eq. 1 over the stiffness, and 2r; push is 0 where none touch
};

}  // namespace sinew::kernel
