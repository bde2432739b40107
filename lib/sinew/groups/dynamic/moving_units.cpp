// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/groups/dynamic/moving_units.h>

#include <Eigen/LU>
#include <algorithm>

#include <sinew/body/body.h>
#include <sinew/body/grouping.h>
#include <sinew/core/parallel.h>

namespace sinew {
namespace {

constexpr std::size_t particles_at_a_time = 8192, units_at_a_time = 8;

}  // namespace

void AffineSums::add(const Vec3& rest, const Vec3& at, const Vec3& velocity) {
  n += 1, X += rest, x += at, v += velocity;
  XX += rest * rest.transpose(), xX += at * rest.transpose(), vX += velocity * rest.transpose();
}

AffineSums& AffineSums::operator+=(const AffineSums& other) {
  n += other.n, X += other.X, x += other.x, v += other.v;
  XX += other.XX, xX += other.xX, vX += other.vX;
  return *this;
}

AffineMap AffineSums::map() const {
  // What lies in a plane or a line has no strain across it that anyone could know.
  const Mat3 S = spread();
  const Mat3 inverse = (S + 1e-9 * S.trace() * Mat3::Identity()).inverse();
  return {X / n, x / n, v / n, (xX - x * X.transpose() / n) * inverse,
          (vX - v * X.transpose() / n) * inverse};
}

Residual Unit::from(const AffineMap& other) const {
  const Mat3 S = sums.spread() / sums.n, dF = map.F - other.F, dV = map.V - other.V;
  const Vec3 to = map.center - other.center;
  const Vec3 dc = map.c - (other.c + other.F * to), dv = map.v - (other.v + other.V * to);
  return {own.x + dc.squaredNorm() + (dF * S).cwiseProduct(dF).sum(),
          own.v + dv.squaredNorm() + (dV * S).cwiseProduct(dV).sum()};
}

MovingUnits::MovingUnits(const Body& body, std::span<const std::int32_t> cell,
                         const BoneAssemblies& assemblies, std::span<const std::int32_t> group,
                         const Particles& particles)
    : body_(body), particles_(particles), place_(particles.size()) {
  for (std::uint32_t k = 0; k < place_.size(); ++k)
    place_[static_cast<std::size_t>(particles.id[k])] = k;
  find(cell, assemblies, group);
  parallel_for(units_.size(), units_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t u = begin; u < end; ++u) measure(units_[u], members(u));
  });
}

void MovingUnits::find(std::span<const std::int32_t> cell, const BoneAssemblies& assemblies,
                       std::span<const std::int32_t> group) {
  std::vector<std::int64_t> key(cell.size(), -1);
  // What is bound to no bone counts as one assembly as well.
  const auto bones = static_cast<int>(body_.skeleton.size());
  const std::int64_t of_cell = bones + 1;
  parallel_for(key.size(), particles_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (group[i] >= 0) continue;
      if (const int assembly = assemblies.of(i); assembly != BoneAssemblies::none)
        key[i] = cell[i] * of_cell + (assembly == BoneAssemblies::without_bones ? bones : assembly);
    }
  });
  std::vector<std::int64_t> keys;
  for (const std::int64_t one : key)
    if (one >= 0 && (keys.empty() || keys.back() != one)) keys.push_back(one);
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  units_.resize(keys.size());
  for (std::size_t u = 0; u < keys.size(); ++u) {
    units_[u].cell = static_cast<std::int32_t>(keys[u] / of_cell);
    units_[u].assembly = static_cast<int>(keys[u] % of_cell);
  }
  std::vector<std::int32_t> unit(key.size(), -1);
  parallel_for(key.size(), particles_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (key[i] >= 0)
        unit[i] = static_cast<std::int32_t>(std::lower_bound(keys.begin(), keys.end(), key[i]) -
                                            keys.begin());
  });
  first_.assign(units_.size() + 1, 0);
  for (const std::int32_t u : unit)
    if (u >= 0) ++first_[static_cast<std::size_t>(u) + 1];
  for (std::size_t u = 0; u < units_.size(); ++u) first_[u + 1] += first_[u];
  std::vector<std::uint32_t> next = first_;
  member_.resize(first_.back());
  for (std::uint32_t i = 0; i < unit.size(); ++i)
    if (unit[i] >= 0) member_[next[static_cast<std::size_t>(unit[i])]++] = i;
}

/// Fits it, and how far its particles are from that.
void MovingUnits::measure(Unit& unit, std::span<const std::uint32_t> members) const {
  const Vec3& origin = body_.rest.front();
  unit.was_in = body_.grouping->group[members.front()];
  for (const std::uint32_t i : members) {
    unit.sums.add(body_.rest[i] - origin, particles_.position(place_[i]) - origin,
                  particles_.velocity(place_[i]));
    if (body_.grouping->group[i] != unit.was_in) unit.was_in = -1;
  }
  unit.map = unit.sums.map();
  const AffineMap& map = unit.map;
  for (const std::uint32_t i : members) {
    const Vec3 from = body_.rest[i] - origin - map.center;
    const Vec3 x = particles_.position(place_[i]) - origin, v = particles_.velocity(place_[i]);
    unit.own.x += (x - map.c - map.F * from).squaredNorm() / unit.sums.n;
    unit.own.v += (v - map.v - map.V * from).squaredNorm() / unit.sums.n;
  }
}

std::vector<CubicSums> MovingUnits::cubic_sums(std::span<const std::size_t> units) const {
  Points middles;
  for (const std::size_t u : units)
    middles.push_back(body_.rest.front() + units_[u].sums.X / units_[u].sums.n);
  std::vector<CubicSums> sums(units.size());
  if (units.empty()) return sums;
  const FitFrame frame(middles);
  parallel_for(units.size(), units_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n)
      for (const std::uint32_t i : members(units[n]))
        sums[n].add(terms_at(frame.at(body_.rest[i])),
                    particles_.position(place_[i]) - body_.rest[i], particles_.velocity(place_[i]));
  });
  return sums;
}

}  // namespace sinew
