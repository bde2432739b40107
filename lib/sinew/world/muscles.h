// SPDX-License-Identifier: GPL-3.0-or-later
// Muscles: fibers in the body that pull along their own direction, as an active stress.
//
//     const Muscles muscles = make_muscles(rest, radius, {muscle});
//     const Activations now = activations_at(muscles, time);
//     const FiberEnergy energy = muscle_forces(muscles, now, particles, forces);
//
// A fiber lies along t0 (unit) at rest and along F t0 in the deformed body, F the least-squares
// deformation gradient over the rest neighbors. At activation a in [0, 1] and strength S (Pa) the
// Kirchhoff stress (force per area times J, as in the virial formula with the rest volume) is a S t
// t^T, t = F t0 / |F t0|. It derives from the potential, per particle of volume V0
// (of the body around it: less or more at a surface),
//   U = a S V0 w ln(lambda),  lambda = |F t0|,
//   force on neighbor j: -V0 P A^-1 X_ij, the opposite on i,  P = a S w (F t0) t0^T / lambda^2,
// with A = sum X X^T at rest and w the particle's weight. P F^T is symmetric, so momentum and
// angular momentum are conserved. Below lambda = 1/2, lambda^2 stays at 1/4 and U continued
// smoothly: a crushed fiber loses its pull instead of gaining without limit. Particles whose
// neighbors at rest lie in a plane have no F, and no fibers.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <sinew/core/deformation.h>
#include <sinew/core/particles.h>
#include <sinew/rig/binding.h>
#include <sinew/world/region.h>

namespace sinew {

/// The weight of a muscle in a particle.
struct MuscleWeight {
  std::uint32_t particle = 0;  ///< id of the particle
  double weight = 1;           ///< in (0, 1]
};

struct Muscle {
  std::string name;
  /// Direction of its fibers at rest (a bone's axis, say), of any length but 0.
  Vec3 direction = Vec3::UnitZ();
  double strength = 0;                ///< S, Pa, tension positive
  KeyedValue activation;              ///< over time, in [0, 1]; 1 without keys
  std::vector<MuscleWeight> weights;  ///< ascending particles
};

/// The particles at `rest` (n x 3, m, by id) in a region, with its weights there.
std::vector<MuscleWeight> weights_in(const Region& region, const Points& rest);

/// The particles bound to a bone, with the bone's weights.
std::vector<MuscleWeight> weights_bound_to(int bone, const Binding& binding);

/// All muscles of a body, with what the rest state determines.
struct Muscles {
  /// One muscle's fiber in one particle.
  struct Fiber {
    std::uint32_t muscle;
    double weight;  ///< with the particle's volume share
  };

  RestShape rest;
  std::vector<Muscle> muscles;        ///< directions of length 1
  std::vector<std::uint32_t> active;  ///< particles with fibers, by id, ascending
  std::vector<std::int32_t> row;      ///< index in active by id, -1 for none
  std::vector<std::uint32_t> first;   ///< one longer than active; fibers of row k
  std::vector<Fiber> fibers;          ///< fibers of a particle in the order of the muscles
  std::vector<double> volume_share;   ///< one per id; empty: 1 each

  double volume_share_of(std::size_t i) const { return volume_share.empty() ? 1 : volume_share[i]; }
};

/// Prepares the muscles of a body at rest (m, by id; neighbors: nearest ones).
/// Throws bad input for a direction of zero length, a strength that is not finite, activations
/// outside [0, 1], weights of unknown particles, out of order or outside (0, 1].
/// `volume_share`: of the body around each particle, by id, over that of one inside; empty: 1 each.
Muscles make_muscles(RestShape rest, std::vector<Muscle> muscles,
                     std::span<const double> volume_share = {});
/// The same of particles of `radius` (m), whose neighbors are searched.
Muscles make_muscles(Points rest, double radius, std::vector<Muscle> muscles,
                     std::span<const double> volume_share = {});

/// The activation of each muscle at one moment.
struct Activations {
  std::vector<double> level;  ///< per muscle
  std::vector<double> rate;   ///< 1/s
};

Activations activations_at(const Muscles& muscles, double time);

/// Energies of the fibers at one moment.
struct FiberEnergy {
  double stored = 0;  ///< sum of U, J
  double power = 0;   ///< its rate of change due to activation alone, W
};

/// Sets forces (n, in the order of `particles`), N. In parallel; the bits do not depend on threads.
FiberEnergy muscle_forces(const Muscles& muscles, const Activations& activations,
                          const Particles& particles, Points& forces);

/// Kirchhoff stress of fibers at each particle, Pa, at places `now` (n x 3, m, by id). Parallel.
std::vector<Mat3> muscle_stress(const Muscles& muscles, const Activations& activations,
                                const Points& now);

/// An upper bound of the stiffness that fully active muscles add to any motion of the body near
/// rest, N/m; fibers shortened to lambda add 1 / lambda^2 times as much.
double muscle_stiffness(const Muscles& muscles, double radius);

}  // namespace sinew
