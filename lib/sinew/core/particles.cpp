// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/particles.h>

#include <numeric>

#include <sinew/core/hash.h>
#include <sinew/core/parallel.h>

namespace sinew {
namespace {

constexpr std::size_t particles_per_piece = 1 << 14;

}  // namespace

void free_motion(Particles& particles) {
  for (auto* axis :
       {&particles.x, &particles.y, &particles.z, &particles.u, &particles.v, &particles.w})
    std::vector<double>().swap(*axis);
}

Particles particles_at_rest(std::size_t count) {
  Particles particles;
  for (auto* axis :
       {&particles.x, &particles.y, &particles.z, &particles.u, &particles.v, &particles.w})
    axis->assign(count, 0.0);
  particles.id.resize(count);
  std::iota(particles.id.begin(), particles.id.end(), 0);
  return particles;
}

Particles particles_at(const Points& positions, double radius, double mass) {
  Particles particles = particles_at_rest(positions.size());
  particles.radius = radius;
  particles.mass = mass;
  for (std::size_t i = 0; i < positions.size(); ++i) particles.set_position(i, positions[i]);
  return particles;
}

Points positions_of(const Particles& particles) {
  Points positions(particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i) positions[i] = particles.position(i);
  return positions;
}

namespace {

template <class Value>
void find_by_id(const Particles& particles, Points& found, const Value& value) {
  found.resize(particles.size());
  parallel_for(particles.size(), particles_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      found[static_cast<std::size_t>(particles.id[i])] = value(i);
  });
}

}  // namespace

Points positions_by_id(const Particles& particles) {
  Points positions;
  find_positions_by_id(particles, positions);
  return positions;
}

void find_positions_by_id(const Particles& particles, Points& positions) {
  find_by_id(particles, positions, [&](std::size_t i) { return particles.position(i); });
}

void find_velocities_by_id(const Particles& particles, Points& velocities) {
  find_by_id(particles, velocities, [&](std::size_t i) { return particles.velocity(i); });
}

std::uint64_t state_hash(const Particles& particles) {
  const std::size_t n = particles.size();
  std::vector<std::uint32_t> at(n);
  for (std::size_t i = 0; i < n; ++i) at[particles.id[i]] = static_cast<std::uint32_t>(i);
  std::vector<std::uint64_t> of_pieces((n + particles_per_piece - 1) / particles_per_piece);
  parallel_for(n, particles_per_piece, [&](std::size_t begin, std::size_t end) {
    Hash hash;
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t i = at[k];
      const double state[6] = {particles.x[i], particles.y[i], particles.z[i],
                               particles.u[i], particles.v[i], particles.w[i]};
      hash.add(state, sizeof state);
    }
    of_pieces[begin / particles_per_piece] = hash.value();
  });
  Hash hash;
  hash.add(of_pieces.data(), of_pieces.size() * sizeof of_pieces[0]);
  return hash.value();
}

}  // namespace sinew
