// SPDX-License-Identifier: GPL-3.0-or-later
// The forces between particles as a pair style of LAMMPS: eq. 1 or bonds, and the damping of eq. 2,
// by the same laws as the built-in steppers. Needs `newton off`, a half list and the velocities of
// ghosts: every own particle then meets all its partners, and no force is sent back.
#pragma once

#include <sinew/lammps/lammps_headers.h>
#include <sinew/lammps/local_body.h>
#include <sinew/material/laws.h>

namespace sinew {

class PairSinew : public LAMMPS_NS::Pair {
 public:
  explicit PairSinew(LAMMPS_NS::LAMMPS* lammps);
  ~PairSinew() override;

  /// The body must outlive the pair style. Before `pair_coeff`.
  void attach(LocalBody& body);

  bool has_bonds() const { return law_->has_bonds; }

  void settings(int, char**) override {}
  void coeff(int, char**) override;
  double init_one(int, int) override;
  void compute(int energies, int virials) override;
  int pack_forward_comm(int count, int* which, double* to, int, int*) override;
  void unpack_forward_comm(int count, int first, double* from) override;

 private:
  struct Meeting {
    int i, j;       ///< local indices; i is own
    Vec3 offset;    ///< vector from j to i, m
    double d;       ///< m
    double force;   ///< N, positive repels
    bool of_both;   ///< j has to hear of it as well
    bool partners;  ///< damping acts between them
  };

  Vec3 position(int i) const { return Eigen::Map<const Vec3>(atom->x[i]); }
  Vec3 velocity(int i) const { return Eigen::Map<const Vec3>(atom->v[i]); }
  /// Points from j to i. Two coincident particles separate along x, the lower id to the left.
  Vec3 direction(const Meeting& pair) const {
    if (pair.d > 0) return pair.offset / pair.d;
    return Vec3(atom->tag[pair.i] < atom->tag[pair.j] ? -1 : 1, 0, 0);
  }
  template <class Visit>
  void for_each_pair(Visit&& visit) const;
  template <class Visit>
  void for_each_bond(Visit&& visit) const;
  template <class Visit>
  void for_each_meeting(Visit&& visit) const;
  template <class Visit>
  void for_each_nearest(Visit&& visit) const;
  void find_partners();
  void mean_damping(const Points& velocities);
  void pairwise_damping();

  enum class Sent { counts, rest, thrust };
  void send(Sent what);
  void find_rest_shapes();
  void find_thrusts();
  void add_volume_forces();

  LocalBody* body_ = nullptr;
  const ForceLaw* law_ = nullptr;
  double range_ = 0;           ///< range of forces between particles that are not bonded, m
  std::vector<int> partners_;  ///< partners in the bonds of own particles, local indices
  Sent sent_ = Sent::counts;   ///< what particles send to their ghosts
  // Where volumes are kept:
  Points rest_;                 ///< places of ghosts as well, m
  std::vector<Mat3> inverse_;   ///< inverses of A_i, 1/m^2
  std::vector<double> weight_;  ///< w_i
  std::vector<Mat3> thrust_;    ///< K_v V0 w_i (J_i - 1) cof(F_i) A_i^-1, of ghosts as well, N/m
};

}  // namespace sinew
