// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/stepping/detail/step_totals.h>

#include <sinew/body/body.h>
#include <sinew/core/parallel.h>

namespace sinew {

StepSums sums_of(std::span<const kernel::Totals> pieces, const Units& units, double mass) {
  const double watts = mass * units.length * units.length / (units.time * units.time * units.time);
  StepSums sums;
  for (const kernel::Totals& piece : pieces) {
    sums.power += piece.power;
    sums.lost += piece.lost;
    sums.world_power += piece.driven_power;
  }
  for (double* sum : {&sums.power, &sums.lost, &sums.world_power}) *sum *= watts;
  return sums;
}

Imbalance imbalance_of(std::span<const kernel::Totals> pieces, const Units& units, double mass) {
  const double L = units.length, T = units.time;
  Imbalance sum;
  for (const kernel::Totals& piece : pieces) {
    sum.aa += piece.relaxing.aa;
    sum.av += piece.relaxing.av;
    sum.vv += piece.relaxing.vv;
    sum.unbalanced += piece.relaxing.unbalanced;
    sum.applied += piece.relaxing.pulled;
    sum.flowing += piece.lost;
  }
  sum.aa *= L * L / (T * T * T * T);
  sum.av *= L * L / (T * T * T);
  sum.vv *= L * L / (T * T);
  const double newtons = mass * L / (T * T);
  sum.flowing *= newtons * L / T;
  sum.unbalanced *= newtons;
  sum.applied = newtons * sum.applied / 2;
  return sum;
}

Energies energies_at(const EnergyMoment& moment) {
  constexpr std::size_t particles_per_sum = 512;
  const auto& [body, now, forces, balance, stepping] = moment;
  const auto sum_of = [&](const auto& value) {
    return parallel_sum(now.size(), particles_per_sum, [&](std::size_t begin, std::size_t end) {
      double sum = 0;
      for (std::size_t i = begin; i < end; ++i)
        sum += value(i, mass_of(body, static_cast<std::size_t>(now.id[i]), now.mass));
      return sum;
    });
  };
  // Velocities are half a step behind the positions, except in velocity Verlet.
  const double behind = stepping.integrator == Integrator::velocity_verlet ? 0 : stepping.step / 2;
  Energies energies;
  energies.kinetic = sum_of([&](std::size_t i, double mass) {
    const Vec3 acceleration = forces.total(i) / mass + stepping.gravity;
    return mass / 2 * (now.velocity(i) + behind * acceleration).squaredNorm();
  });
  energies.gravity = sum_of(
      [&](std::size_t i, double mass) { return -(mass * stepping.gravity.dot(now.position(i))); });
  energies.pair = balance.pair_energy;
  energies.bone = balance.bone_energy;
  energies.contact = balance.contact_energy;
  return energies;
}

}  // namespace sinew
