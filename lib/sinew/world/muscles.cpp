// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/world/muscles.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/error.h>
#include <sinew/core/parallel.h>
#include <sinew/core/particles.h>
#include <sinew/core/text.h>

namespace sinew {
namespace {

constexpr std::size_t muscle_particles_per_task = 1024;
// A fiber at half its length is far beyond what living muscles do (0.6).
constexpr double crushed = 0.5;

[[noreturn]] void refuse(const Muscle& muscle, const std::string& wrong, const std::string& cure) {
  throw bad_input("muscle '" + muscle.name + "' " + wrong, cure);
}

void check_weights(const Muscle& muscle, std::size_t count) {
  if (muscle.weights.empty())
    refuse(muscle, "has 0 particles", "place its region on the body at rest");
  for (std::size_t k = 0; k < muscle.weights.size(); ++k) {
    const MuscleWeight& entry = muscle.weights[k];
    if (entry.particle >= count || (k > 0 && entry.particle <= muscle.weights[k - 1].particle))
      refuse(muscle, "names particle " + std::to_string(entry.particle) + " out of order",
             "give particles of the body, ascending");
    if (!(entry.weight > 0 && entry.weight <= 1))
      refuse(muscle, "has a share of " + number_text(entry.weight), "give shares in (0, 1]");
  }
}

void check_muscle(const Muscle& muscle, std::size_t count) {
  if (!muscle.direction.allFinite() || !(muscle.direction.norm() > 0))
    refuse(muscle, "has a direction without length", "give a direction");
  if (!std::isfinite(muscle.strength))
    refuse(muscle, "has a strength of " + number_text(muscle.strength), "give a finite stress");
  check_keys(muscle.activation, 0, 1, "the activation of muscle '" + muscle.name + "'");
  check_weights(muscle, count);
}

/// Sorts the weights of all muscles by particle.
void sort_fibers(Muscles& all) {
  const std::size_t count = all.rest.points.size();
  std::vector<std::vector<Muscles::Fiber>> of(count);
  for (std::size_t m = 0; m < all.muscles.size(); ++m)
    for (const MuscleWeight& entry : all.muscles[m].weights)
      if (all.rest.defined(entry.particle))
        of[entry.particle].push_back(
            {static_cast<std::uint32_t>(m), entry.weight * all.volume_share_of(entry.particle)});
  all.row.assign(count, -1);
  all.first.assign(1, 0);
  for (std::size_t i = 0; i < count; ++i) {
    if (of[i].empty()) continue;
    all.row[i] = static_cast<std::int32_t>(all.active.size());
    all.active.push_back(static_cast<std::uint32_t>(i));
    all.fibers.insert(all.fibers.end(), of[i].begin(), of[i].end());
    all.first.push_back(static_cast<std::uint32_t>(all.fibers.size()));
  }
}

/// ln(lambda), continued below the crushed length with the same slope there.
double log_length(double squared) {
  constexpr double least = crushed * crushed;
  if (squared >= least) return std::log(squared) / 2;
  return (std::log(least) + squared / least - 1) / 2;
}

/// P of one particle's fibers at the deformation gradient F, Pa.
Mat3 nominal_stress(const Muscles& all, const Activations& now, std::size_t row, const Mat3& F) {
  Mat3 P = Mat3::Zero();
  for (std::size_t k = all.first[row]; k < all.first[row + 1]; ++k) {
    const Muscles::Fiber& fiber = all.fibers[k];
    const Muscle& muscle = all.muscles[fiber.muscle];
    const Vec3 along = F * muscle.direction;
    const double squared = std::max(along.squaredNorm(), crushed * crushed);
    const double pull = now.level[fiber.muscle] * muscle.strength * fiber.weight / squared;
    P += pull * along * muscle.direction.transpose();
  }
  return P;
}

/// Energies per volume at rest, J/m^3 and W/m^3.
FiberEnergy energy_density(const Muscles& all, const Activations& now, std::size_t row,
                           const Mat3& F) {
  FiberEnergy energy;
  for (std::size_t k = all.first[row]; k < all.first[row + 1]; ++k) {
    const Muscles::Fiber& fiber = all.fibers[k];
    const Muscle& muscle = all.muscles[fiber.muscle];
    const double at_full =
        muscle.strength * fiber.weight * log_length((F * muscle.direction).squaredNorm());
    energy.stored += now.level[fiber.muscle] * at_full;
    energy.power += now.rate[fiber.muscle] * at_full;
  }
  return energy;
}

Points by_id(const Particles& particles) {
  Points points(particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i)
    points[particles.id[i]] = particles.position(i);
  return points;
}

/// F of every particle with fibers.
std::vector<Mat3> active_gradients(const Muscles& all, const Points& now) {
  std::vector<Mat3> F(all.active.size());
  parallel_for(F.size(), muscle_particles_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row)
      F[row] = deformation_gradient(all.rest, now, all.active[row]);
  });
  return F;
}

/// V0 P A^-1 of every particle with fibers: times an offset at rest it is a force, N.
std::vector<Mat3> pulls(const Muscles& all, const Activations& activations,
                        const std::vector<Mat3>& F, double volume) {
  std::vector<Mat3> by_offset(F.size());
  parallel_for(F.size(), muscle_particles_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row)
      by_offset[row] = volume * nominal_stress(all, activations, row, F[row]) *
                       all.rest.inverse[all.active[row]];
  });
  return by_offset;
}

FiberEnergy energy_of(const Muscles& all, const Activations& activations,
                      const std::vector<Mat3>& F, double volume) {
  FiberEnergy sum;
  for (std::size_t row = 0; row < F.size(); ++row) {
    const FiberEnergy density = energy_density(all, activations, row, F[row]);
    sum.stored += volume * density.stored;
    sum.power += volume * density.power;
  }
  return sum;
}

/// (M_i + M_j) X_ij over the neighbors: the pull of i itself and that of each of them.
Vec3 force_on(const Muscles& all, const std::vector<Mat3>& by_offset, std::uint32_t i) {
  const auto of = [&](std::uint32_t p) {
    return all.row[p] < 0 ? nullptr : &by_offset[static_cast<std::size_t>(all.row[p])];
  };
  const Mat3* own = of(i);
  Vec3 force = Vec3::Zero();
  for (const auto j : all.rest.neighbors.of(i)) {
    const Mat3* other = of(j);
    if (!own && !other) continue;
    const Vec3 offset = all.rest.points[j] - all.rest.points[i];
    // Each term alone, as j adds it with the opposite sign: forces sum up to zero but for rounding.
    if (own) force += *own * offset;
    if (other) force += *other * offset;
  }
  return force;
}

/// |dU/dx| of one particle's fibers is V0 S |c|: c_j = (A^-1 t0).X_ij for a neighbor, and minus
/// their sum for the particle itself.
struct Coefficients {
  double own = 0, all = 0;  ///< |sum c|; that and sum |c|
};

Coefficients coefficients(const RestShape& rest, std::size_t i, const Vec3& covector) {
  double sum = 0, magnitudes = 0;
  for (const auto j : rest.neighbors.of(i)) {
    const double c = covector.dot(rest.points[j] - rest.points[i]);
    sum += c;
    magnitudes += std::abs(c);
  }
  return {std::abs(sum), std::abs(sum) + magnitudes};
}

/// Adds the sums of the rows of |c c^T| over particle i's fibers, to each row.
void add_rows(const Muscles& all, std::size_t row, std::vector<double>& sums) {
  const std::uint32_t i = all.active[row];
  for (std::size_t k = all.first[row]; k < all.first[row + 1]; ++k) {
    const Muscle& muscle = all.muscles[all.fibers[k].muscle];
    const Vec3 covector = all.rest.inverse[i] * muscle.direction;
    const Coefficients c = coefficients(all.rest, i, covector);
    const double scale =
        std::abs(muscle.strength) * muscle.activation.largest() * all.fibers[k].weight * c.all;
    sums[i] += scale * c.own;
    for (const auto j : all.rest.neighbors.of(i))
      sums[j] += scale * std::abs(covector.dot(all.rest.points[j] - all.rest.points[i]));
  }
}

}  // namespace

std::vector<MuscleWeight> weights_in(const Region& region, const Points& rest) {
  std::vector<MuscleWeight> weights;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const double weight = region.weight(rest[i]);
    if (weight > 0) weights.push_back({static_cast<std::uint32_t>(i), weight});
  }
  return weights;
}

std::vector<MuscleWeight> weights_bound_to(int bone, const Binding& binding) {
  std::vector<MuscleWeight> weights;
  for (std::size_t i = 0; i + 1 < binding.first.size(); ++i)
    for (const Influence& influence : binding.of(i))
      if (influence.bone == bone && influence.weight > 0)
        weights.push_back({static_cast<std::uint32_t>(i), std::min(influence.weight, 1.0)});
  return weights;
}

Muscles make_muscles(RestShape rest, std::vector<Muscle> muscles,
                     std::span<const double> volume_share) {
  for (Muscle& muscle : muscles) {
    check_muscle(muscle, rest.points.size());
    muscle.direction.normalize();
  }
  Muscles all;
  all.rest = std::move(rest);
  all.muscles = std::move(muscles);
  all.volume_share.assign(volume_share.begin(), volume_share.end());
  sort_fibers(all);
  return all;
}

Muscles make_muscles(Points rest, double radius, std::vector<Muscle> muscles,
                     std::span<const double> volume_share) {
  return make_muscles(rest_shape(std::move(rest), rest_neighbor_range(radius)), std::move(muscles),
                      volume_share);
}

Activations activations_at(const Muscles& muscles, double time) {
  Activations now;
  for (const Muscle& muscle : muscles.muscles) {
    now.level.push_back(muscle.activation.at(time));
    now.rate.push_back(muscle.activation.rate(time));
  }
  return now;
}

FiberEnergy muscle_forces(const Muscles& muscles, const Activations& activations,
                          const Particles& particles, Points& forces) {
  forces.assign(particles.size(), Vec3::Zero());
  if (muscles.active.empty()) return {};
  const double volume = volume_per_particle(particles.radius);
  const auto F = active_gradients(muscles, by_id(particles));
  const auto by_offset = pulls(muscles, activations, F, volume);
  parallel_for(
      particles.size(), muscle_particles_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
          forces[i] = force_on(muscles, by_offset, static_cast<std::uint32_t>(particles.id[i]));
      });
  return energy_of(muscles, activations, F, volume);
}

std::vector<Mat3> muscle_stress(const Muscles& muscles, const Activations& activations,
                                const Points& now) {
  std::vector<Mat3> stress(now.size(), Mat3::Zero());
  const auto F = active_gradients(muscles, now);
  parallel_for(F.size(), muscle_particles_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const std::uint32_t i = muscles.active[row];
      if (muscles.volume_share_of(i) > 0)
        stress[i] = nominal_stress(muscles, activations, row, F[row]) * F[row].transpose() /
                    muscles.volume_share_of(i);
    }
  });
  return stress;
}

double muscle_stiffness(const Muscles& muscles, double radius) {
  std::vector<double> sums(muscles.rest.points.size(), 0.0);
  for (std::size_t row = 0; row < muscles.active.size(); ++row) add_rows(muscles, row, sums);
  double most = 0;
  for (const double sum : sums) most = std::max(most, sum);
  return volume_per_particle(radius) * most;
}

}  // namespace sinew
