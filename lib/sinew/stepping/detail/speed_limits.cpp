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

void add_to_velocities(SimulationState& state, double by, double unit_of_time,
                       const std::function<Vec3(std::size_t i)>& gain) {
  const double unit = std::holds_alternative<MovingInSingle>(state.moving)
                          ? state.fixed_point_units.length / unit_of_time
                          : 1;
  const auto shift = [&](auto& moving) {
    for (std::size_t k = 0; k < moving.x[0].size(); ++k) {
      const Vec3 added = by / unit * gain(state.order.empty() ? k : state.order[k]);
      for (int axis = 0; axis < 3; ++axis) {
        auto& v = moving.v[axis][k];
        v = static_cast<std::remove_reference_t<decltype(v)>>(v + added[axis]);
      }
    }
  };
  std::visit(shift, state.moving);
}

}  // namespace sinew
