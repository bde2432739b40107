// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/body/forces.h>

#include <algorithm>

#include <sinew/body/pair_pass.h>
#include <sinew/core/parallel.h>

namespace sinew {

namespace {

constexpr std::size_t particles_per_task = 512, particles_per_sum = 16384;

ParticleState state_of(const Particles& particles, const Body& body, std::size_t i) {
  return {body.rest[particles.id[i]], particles.position(i), particles.velocity(i),
          particles.radius};
}

/// Calls visit(bone, pull) for every bone that holds particle i.
template <class Visit>
void for_each_pull(const Particles& particles, const Body& body, const Pose& pose, std::size_t i,
                   Visit&& visit) {
  const ParticleState particle = state_of(particles, body, i);
  for (const Influence& influence : body.binding.of(particles.id[i])) {
    const int b = influence.bone;
    visit(b, bone_pull(body.springs[b], influence, body.skeleton.bones[b], pose[b], particle));
  }
}

}  // namespace

void bone_forces(const Particles& particles, const Body& body, const Pose& pose, Forces& forces) {
  const std::size_t n = particles.size();
  for (auto* vectors : {&forces.bone, &forces.bone_damping}) vectors->assign(n, Vec3::Zero());
  for (auto* powers : {&forces.bone_power, &forces.bone_damping_power}) powers->assign(n, 0.0);
  parallel_for(n, particles_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for_each_pull(particles, body, pose, i, [&](int, const BonePull& pull) {
        forces.bone[i] += pull.force();
        forces.bone_damping[i] += pull.damping;
        forces.bone_power[i] += pull.power;
        forces.bone_damping_power[i] += pull.damping_power;
      });
  });
}

std::vector<Reaction> reactions(const Particles& particles, const Points& pulls, const Body& body,
                                const Pose& pose) {
  const std::size_t pieces = particles.size() / particles_per_sum + 1;
  std::vector<std::vector<Reaction>> parts(pieces, std::vector<Reaction>(pose.size()));
  parallel_for(particles.size(), particles_per_sum, [&](std::size_t begin, std::size_t end) {
    auto& part = parts[begin / particles_per_sum];
    const auto add = [&](int b, std::size_t i, const Vec3& force, double power) {
      part[b].force -= force;
      part[b].moment -= (particles.position(i) - pose[b].frame.origin).cross(force);
      part[b].power += power;
    };
    for (std::size_t i = begin; i < end; ++i) {
      const auto bones = body.binding.of(particles.id[i]);
      if (bones.size() == 1 && pose[bones[0].bone].stretch_rate == 0) {
        const int b = bones[0].bone;
        add(b, i, pulls[i], pulls[i].dot(pose[b].rigid_velocity_at(particles.position(i))));
      } else {
        for_each_pull(particles, body, pose, i,
                      [&](int b, const BonePull& pull) { add(b, i, pull.force(), pull.power); });
      }
    }
  });
  std::vector<Reaction> on(pose.size());
  for (const auto& part : parts)  // in the order of the pieces, whichever thread computed them
    for (std::size_t b = 0; b < on.size(); ++b) on[b] += part[b];
  return on;
}

std::vector<Reaction> BoneReactions::sums() const {
  std::vector<Reaction> all = springs;
  for (const auto* part : {&pins, &obstacles})
    for (std::size_t b = 0; b < part->size(); ++b) all[b] += (*part)[b];
  return all;
}

double bone_energy(const Particles& particles, const Body& body, const Pose& pose) {
  return parallel_sum(particles.size(), particles_per_task,
                      [&](std::size_t begin, std::size_t end) {
                        double sum = 0;
                        for (std::size_t i = begin; i < end; ++i)
                          for_each_pull(particles, body, pose, i,
                                        [&](int, const BonePull& pull) { sum += pull.energy; });
                        return sum;
                      });
}

namespace {

/// Calls visit(j, offset, d) for every j that acts on i by eq. 1.
struct AllNear {
  const Particles& particles;
  double range;
  const Body* body = nullptr;  ///< some particles of which pass through each other
  CellGrid cells = cells_of(particles, range);

  template <class Visit>
  void of(std::size_t i, const Visit& visit) const {
    for_each_neighbor(
        particles, cells, range, i, [&](std::uint32_t j, const Vec3& offset, double d) {
          if (body == nullptr || !pass_through(*body, static_cast<std::size_t>(particles.id[i]),
                                               static_cast<std::size_t>(particles.id[j])))
            visit(j, offset, d);
        });
  }
};

const Body* if_it_passes(const Body& body) { return body.pass_through.any() ? &body : nullptr; }

void forces_of(const AllNear& near, const Material& material, Forces& forces) {
  const auto for_each_partner = [&](std::size_t i, auto&& visit) {
    near.of(i, [&](std::uint32_t j, const Vec3& offset, double d) {
      visit(j, offset, d, material.pair.force(d));
    });
  };
  pair_pass(near.particles, material, for_each_partner, forces);
}

double energy_of(const AllNear& near, const PairForce& pair) {
  return sum_over_particles(near.particles.size(), [&](std::size_t i) {
    double sum = 0;
    near.of(i, [&](std::uint32_t, const Vec3&, double d) {
      sum += pair.potential(d) / 2;  // half for each of the two
    });
    return sum;
  });
}

}  // namespace

void pair_forces(const Particles& particles, const Material& material, Forces& forces) {
  forces_of({particles, material.pair.b}, material, forces);
}

void pair_forces(const Particles& particles, const Body& body, Forces& forces) {
  forces_of({particles, body.material.pair.b, if_it_passes(body)}, body.material, forces);
}

Reaction resultant(const Particles& particles, const Forces& forces, const Body& body,
                   const Vec3& gravity) {
  const auto mass = [&](std::size_t i) {
    return mass_of(body, static_cast<std::size_t>(particles.id[i]), particles.mass);
  };
  const auto force = [&](std::size_t i) -> Vec3 {
    const Vec3 sum = forces.bone[i] + mass(i) * gravity;
    return forces.world.empty() ? sum : Vec3(sum + forces.world[i]);
  };
  Vec3 center = Vec3::Zero();
  double all = 0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    center += mass(i) * particles.position(i);
    all += mass(i);
  }
  center /= all;
  Reaction sum;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    sum.force += force(i);
    sum.moment += (particles.position(i) - center).cross(force(i));
  }
  return sum;
}

double pair_energy(const Particles& particles, const PairForce& pair) {
  return energy_of({particles, pair.b}, pair);
}

double pair_energy(const Particles& particles, const Body& body) {
  const PairForce& pair = body.material.pair;
  return energy_of({particles, pair.b, if_it_passes(body)}, pair);
}

}  // namespace sinew
