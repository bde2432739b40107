// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/stepping/detail/speed_limits.h>

namespace sinew {

SpeedChange slowed(const Body& body, const Pose& pose, const Particles& particles,
                   const Forces& forces, const Stepping& stepping,
                   const std::vector<Offender>& offenders, double radii) {
  const double most = radii * particles.radius / stepping.step;
  SpeedChange change;
  change.gain.assign(particles.size(), Vec3::Zero());
  for (const Offender& one : offenders) {
    const std::size_t i = one.particle;
    const auto id = static_cast<std::size_t>(particles.id[i]);
    const int bone = body.binding.bone(id);
    if (!one.finite || bone == no_bone) continue;
    const double mass = mass_of(body, id, particles.mass);
    const Vec3 carried = pose[static_cast<std::size_t>(bone)].velocity_at(particles.position(i));
    const Vec3 after =
        particles.velocity(i) + stepping.step * (forces.total(i) / mass + stepping.gravity);
    const double speed = (after - carried).norm();
    if (speed <= most) continue;
    change.gain[i] = (most / speed - 1) * (after - carried);
    change.particles.push_back(i);
    change.impulse += mass * change.gain[i];
    change.work += mass * change.gain[i].dot(carried);
  }
  return change;
}

}  // namespace sinew
