// SPDX-License-Identifier: GPL-3.0-or-later
// The bones and the steps as a fix of LAMMPS: carries the particles' rows from rank to rank, adds
// the bones' forces, watches for particles that move too far, and integrates as section 6 of the
// model says.
#pragma once

#include <filesystem>
#include <functional>

#include <sinew/body/ledger.h>
#include <sinew/engine/engine_talk.h>
#include <sinew/engine/engine_world.h>
#include <sinew/lammps/lammps_headers.h>
#include <sinew/lammps/local_body.h>
#include <sinew/rig/motion.h>

namespace sinew {

class FixSinew : public LAMMPS_NS::Fix {
 public:
  FixSinew(LAMMPS_NS::LAMMPS* lammps, int words, char** word);
  ~FixSinew() override;

  /// Before particles are created. `interruption`: asked by every rank in every step. The body must
  /// outlive the fix.
  void attach(LocalBody& body, std::function<Interruption()> interruption);

  /// The world around it, whose poses are in that file. Before positions of particles are used.
  void surround(const std::filesystem::path& poses);
  /// Moves what is held to its place at the present moment.
  void hold();

  /// Sets the size of the steps that follow, s. Forces must be those of the present moment, and are
  /// obsolete afterwards: velocities change where they are half a step behind.
  void change_step(double step);
  double step() const { return step_; }

  std::int64_t steps() const { return moment_.steps; }
  /// At the moment of the positions, m/s.
  Vec3 velocity_of(int i) const;
  /// With this rank's part of the energies.
  const EngineMoment& moment() const { return moment_; }
  /// Why the last stretch ended.
  Interruption interrupted() const { return interrupted_; }
  void go_on() { interrupted_ = Interruption::none; }

  int setmask() override;
  void setup(int virials) override { post_force(virials); }
  void initial_integrate(int) override;
  void post_force(int) override;
  void setup_pre_exchange() override { pre_exchange(); }
  void pre_exchange() override;

  void grow_arrays(int most) override;
  void copy_arrays(int from, int to, int) override;
  int pack_exchange(int i, double* to) override;
  int unpack_exchange(int i, double* from) override;

 private:
  Vec3 position(int i) const { return Eigen::Map<const Vec3>(atom->x[i]); }
  Vec3 velocity(int i) const { return Eigen::Map<const Vec3>(atom->v[i]); }
  Vec3 acceleration(int i) const;
  bool is_sound(int i, const Vec3& kicked, const Pose& pose) const;
  bool kick(double kick);
  void drift();
  double lost() const;
  void find_world_forces();
  void add_to_ledgers();

  LocalBody* body_ = nullptr;
  std::function<Interruption()> interruption_;
  std::optional<PoseCursor> pose_;
  StepPlan plan_;
  double step_ = 0;
  EngineMoment moment_;
  EnergyLedger ledger_{0};
  double power_ = 0, damping_power_ = 0;  ///< power of the bones on own particles, W
  std::optional<EngineWorld> around_;
  std::vector<ParticleWorld> on_;  ///< one per local index
  Points load_;
  EnergyLedger world_ledger_{0};
  Points kicked_;  ///< velocities after the step
  Interruption interrupted_ = Interruption::none;
};

}  // namespace sinew
