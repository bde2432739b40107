// SPDX-License-Identifier: GPL-3.0-or-later
// What surrounds the body, as the built-in steppers apply it: held particles before all forces,
// the world's forces after them.
#include <sinew/lammps/fix_sinew.h>

namespace sinew {

void FixSinew::surround(const std::filesystem::path& poses) {
  if (!body_->setup.world) return;
  around_.emplace(poses, *body_->setup.world, body_->setup.start.steps);
}

void FixSinew::hold() {
  if (!around_) return;
  const double time = plan_.time(moment_.steps);
  around_->go_to(moment_.steps, time);
  const World& around = *body_->setup.world;
  if (around.pins.empty()) return;
  const Pose& pose = pose_->at(time);
  for (int i = 0; i < atom->nlocal; ++i) {
    const Pinned* pin = around_->held(id_of(atom->tag[i]));
    if (pin == nullptr) continue;
    const PinPose place = held_place(*pin, body_->row(i).rest(), around, around_->now().supports,
                                     body_->setup.skeleton, pose);
    const Vec3 x = position(i), v = velocity(i);
    Eigen::Map<Vec3>(atom->x[i]) = x - held_part(*pin, x) + held_part(*pin, place.position);
    Eigen::Map<Vec3>(atom->v[i]) = v - held_part(*pin, v) + held_part(*pin, place.velocity);
  }
}

/// Dry friction answers all other forces, and pins and supports take whatever is left.
void FixSinew::find_world_forces() {
  const EngineSetup& setup = body_->setup;
  const auto own = static_cast<std::size_t>(atom->nlocal);
  const Vec3 weight = setup.material.mass * setup.stepping.gravity;
  std::vector<Reaction> on_obstacles(setup.world->obstacles.size());
  body_->world.assign(own, Vec3::Zero());
  on_.resize(own);
  load_.resize(own);
  for (int i = 0; i < atom->nlocal; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const std::int32_t number = id_of(atom->tag[i]);
    const ParticleState particle{
        {}, position(i), velocity(i), setup.material.pair.r, static_cast<std::size_t>(number)};
    Eigen::Map<Vec3> all(atom->f[i]);
    load_[at] = around_->load(number);
    on_[at] = world_on(particle, setup.material.mass, *setup.world, around_->now(),
                       all + load_[at] + weight, step_, on_obstacles);
    Vec3& push = body_->world[at];
    push = load_[at] + on_[at].force();
    if (const Pinned* pin = around_->held(number)) push -= held_part(*pin, all + push + weight);
    all += push;
  }
}

void FixSinew::add_to_ledgers() {
  double lost = this->lost(), power = 0, held_kinetic = 0;
  for (int i = 0; around_ && i < atom->nlocal; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const Vec3 now = velocity(i) + step_ / 2 * acceleration(i);
    const ParticleWorld& on = on_[at];
    lost += on.losing_power - on.losing.dot(now);
    power += on.power + (on.field + load_[at]).dot(now);
    const Pinned* pin = around_->held(id_of(atom->tag[i]));
    if (pin == nullptr) continue;
    const Vec3 own = held_part(*pin, now);
    power += (body_->world[at] - on.force() - load_[at]).dot(own);
    held_kinetic += body_->setup.material.mass / 2 * own.squaredNorm();
  }
  if (moment_.steps == 0) moment_.ledgers.held_at_start = held_kinetic;
  ledger_.add_step(power_, lost);
  world_ledger_.add_step(power, 0);
  moment_.ledgers.of_bones = ledger_.entries();
  moment_.ledgers.of_world = world_ledger_.entries();
}

}  // namespace sinew
