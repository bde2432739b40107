// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/lammps/fix_sinew.h>

#include <mpi.h>
#include <algorithm>

#include <sinew/body/bone_force.h>

namespace sinew {

FixSinew::FixSinew(LAMMPS_NS::LAMMPS* lammps, int words, char** word) : Fix(lammps, words, word) {
  time_integrate = 1;
  atom->add_callback(LAMMPS_NS::Atom::GROW);  // later, LAMMPS would not find this fix
}

FixSinew::~FixSinew() { atom->delete_callback(id, LAMMPS_NS::Atom::GROW); }

void FixSinew::attach(LocalBody& body, std::function<Interruption()> interruption) {
  const EngineSetup& setup = body.setup;
  body_ = &body;
  interruption_ = std::move(interruption);
  pose_.emplace(setup.skeleton, setup.motion);
  plan_ = setup.plan();
  moment_ = setup.start;
  if (comm->me > 0) {
    moment_.ledgers.of_bones = {0, 0, 0, setup.start.ledgers.of_bones.begun};
    moment_.ledgers.of_world = {0, 0, 0, setup.start.ledgers.of_world.begun};
    moment_.ledgers.held_at_start = 0;
  }
  step_ = plan_.step(std::max<std::int64_t>(0, moment_.steps - 1));
  ledger_.restore(moment_.ledgers.of_bones, step_);
  world_ledger_.restore(moment_.ledgers.of_world, step_);
  maxexchange = static_cast<int>(body.width);
  grow_arrays(atom->nmax);
}

int FixSinew::setmask() {
  using namespace LAMMPS_NS::FixConst;
  return INITIAL_INTEGRATE | POST_FORCE | PRE_EXCHANGE;
}

Vec3 FixSinew::acceleration(int i) const {
  return Eigen::Map<const Vec3>(atom->f[i]) / body_->setup.material.mass +
         body_->setup.stepping.gravity;
}

/// Adds the half step that velocities of velocity Verlet are behind.
Vec3 FixSinew::velocity_of(int i) const {
  const bool behind =
      body_->setup.stepping.integrator == Integrator::velocity_verlet && moment_.kicked;
  return behind ? Vec3(velocity(i) + step_ / 2 * acceleration(i)) : velocity(i);
}

void FixSinew::post_force(int) {
  const EngineSetup& setup = body_->setup;
  const Pose& pose = pose_->at(plan_.time(moment_.steps));
  const auto own = static_cast<std::size_t>(atom->nlocal);
  body_->bone.assign(own, Vec3::Zero());
  body_->bone_damping.assign(own, Vec3::Zero());
  power_ = damping_power_ = 0;
  for (int i = 0; i < atom->nlocal; ++i) {
    const ParticleRow row = body_->row(i);
    const ParticleState particle{row.rest(), position(i), velocity(i), setup.material.pair.r,
                                 static_cast<std::size_t>(id_of(atom->tag[i]))};
    for (int k = 0; k < row.bones(); ++k) {
      const Influence influence = row.influence(k);
      const auto b = static_cast<std::size_t>(influence.bone);
      const BonePull pull =
          bone_pull(setup.springs[b], influence, setup.skeleton.bones[b], pose[b], particle);
      body_->bone[static_cast<std::size_t>(i)] += pull.force();
      body_->bone_damping[static_cast<std::size_t>(i)] += pull.damping;
      power_ += pull.power;
      damping_power_ += pull.damping_power;
    }
    Eigen::Map<Vec3>(atom->f[i]) += body_->bone[static_cast<std::size_t>(i)];
  }
  if (around_) find_world_forces();
}

/// To damping at the moment of the positions, W. Velocities are half a step behind the forces.
double FixSinew::lost() const {
  double lost = damping_power_;
  for (int i = 0; i < atom->nlocal; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const Vec3 now = velocity(i) + step_ / 2 * acceleration(i);
    lost -= (body_->bone_damping[at] + body_->damping[at]).dot(now);
  }
  return lost;
}

/// Whether it moves less than is possible, over the step and relative to its bone or, without one,
/// to its previous motion. Also false for values that are not numbers.
bool FixSinew::is_sound(int i, const Vec3& kicked, const Pose& pose) const {
  const ParticleRow row = body_->row(i);
  const Vec3 before = position(i), v = velocity(i);
  const Vec3 carried =
      row.bones() == 0 || (around_ && around_->held(id_of(atom->tag[i])))
          ? v
          : pose[static_cast<std::size_t>(row.influence(0).bone)].velocity_at(before);
  const double most = max_radii_per_step * body_->setup.material.pair.r;
  const bool drifts_first = body_->setup.stepping.integrator == Integrator::explicit_euler;
  return (step_ * (kicked - carried)).squaredNorm() <= most * most &&
         (before + step_ * (drifts_first ? v : kicked)).allFinite();
}

/// Finds the next velocities; false where a particle is unsound.
bool FixSinew::kick(double kick) {
  const Pose& pose = pose_->at(plan_.time(moment_.steps));
  bool sound = true;
  kicked_.resize(static_cast<std::size_t>(atom->nlocal));
  for (int i = 0; i < atom->nlocal; ++i) {
    Vec3& kicked = kicked_[static_cast<std::size_t>(i)];
    kicked = velocity(i) + kick * acceleration(i);
    sound &= is_sound(i, kicked, pose);
  }
  return sound;
}

void FixSinew::drift() {
  const bool drifts_first = body_->setup.stepping.integrator == Integrator::explicit_euler;
  for (int i = 0; i < atom->nlocal; ++i) {
    const Vec3& kicked = kicked_[static_cast<std::size_t>(i)];
    Eigen::Map<Vec3>(atom->x[i]) += step_ * (drifts_first ? velocity(i) : kicked);
    Eigen::Map<Vec3>(atom->v[i]) = kicked;
  }
}

/// The step, from the forces that the one before has left; all ranks take it, or none does.
void FixSinew::initial_integrate(int) {
  const bool half =
      body_->setup.stepping.integrator == Integrator::velocity_verlet && !moment_.kicked;
  const bool sound = kick(half ? step_ / 2 : step_);
  const Interruption here = sound ? interruption_() : Interruption::unstable;
  MPI_Allreduce(&here, &interrupted_, 1, MPI_INT, MPI_MAX, world);
  if (interrupted_ != Interruption::none) timer->force_timeout();
  if (interrupted_ == Interruption::unstable) return;
  add_to_ledgers();
  drift();
  moment_.kicked = true;
  ++moment_.steps;
  hold();
}

void FixSinew::change_step(double step) {
  const bool behind =
      body_->setup.stepping.integrator != Integrator::explicit_euler && moment_.steps > 0;
  if (behind)
    for (int i = 0; i < atom->nlocal; ++i)
      Eigen::Map<Vec3>(atom->v[i]) += (step_ - step) / 2 * acceleration(i);
  step_ = step;
  ledger_.set_step(step);
  world_ledger_.set_step(step);
}

/// Ghosts reach as far as the longest bond can be before lists are made again.
void FixSinew::pre_exchange() {
  if (body_->setup.shape.nearest == 0) return;
  double longest = 0;
  MPI_Allreduce(&body_->longest_bond, &longest, 1, MPI_DOUBLE, MPI_MAX, world);
  comm->cutghostuser = longest + body_->setup.material.pair.r;
}

void FixSinew::grow_arrays(int most) {
  if (body_ == nullptr) return;
  body_->rows.resize(static_cast<std::size_t>(most) * body_->width);
}

void FixSinew::copy_arrays(int from, int to, int) {
  std::copy_n(body_->numbers(from), body_->width, body_->numbers(to));
}

int FixSinew::pack_exchange(int i, double* to) {
  std::copy_n(body_->numbers(i), body_->width, to);
  return static_cast<int>(body_->width);
}

int FixSinew::unpack_exchange(int i, double* from) {
  std::copy_n(from, body_->width, body_->numbers(i));
  return static_cast<int>(body_->width);
}

}  // namespace sinew
