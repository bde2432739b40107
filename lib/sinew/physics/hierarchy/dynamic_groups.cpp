// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/physics/hierarchy/dynamic_groups.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include <sinew/core/parallel.h>
#include <sinew/physics/forces.h>
#include <sinew/physics/hierarchy/static_groups.h>

namespace sinew {
namespace {

constexpr double cell_edge = 8;  // diameters
constexpr std::size_t particles_at_a_time = 8192;
constexpr int moments_ahead = 16;
// Groups are worth the work of making them if no joint of theirs moves for so many checks.
constexpr double checks_ahead = 16;
constexpr int most_rounds = 4;      // of what is grown and found not to fit
constexpr double free_share = 0.5;  // of the tolerance, for what was free
constexpr double torn_share = 0.5;  // of the tolerance: what leaves where something must
// Of a particle that is moved while its neighbors stay, in stiffnesses of a bond.
constexpr double stiffness_of_place = 4;

/// x = c + F (X - center), and its rate.
struct AffineMap {
  Vec3 center = Vec3::Zero(), c = Vec3::Zero(), v = Vec3::Zero();
  Mat3 F = Mat3::Identity(), V = Mat3::Zero();
};

/// Over particles, of places that are near the origin.
struct Sums {
  double n = 0;
  Vec3 X = Vec3::Zero(), x = Vec3::Zero(), v = Vec3::Zero();
  Mat3 XX = Mat3::Zero(), xX = Mat3::Zero(), vX = Mat3::Zero();

  void add(const Vec3& rest, const Vec3& at, const Vec3& velocity) {
    n += 1, X += rest, x += at, v += velocity;
    XX += rest * rest.transpose(), xX += at * rest.transpose(), vX += velocity * rest.transpose();
  }
  Sums& operator+=(const Sums& other) {
    n += other.n, X += other.X, x += other.x, v += other.v;
    XX += other.XX, xX += other.xX, vX += other.vX;
    return *this;
  }
  Mat3 spread() const { return XX - X * X.transpose() / n; }
  /// By least squares.
  AffineMap map() const {
    // What lies in a plane or a line has no strain across it that anyone could know.
    const Mat3 S = spread();
    const Mat3 inverse = (S + 1e-9 * S.trace() * Mat3::Identity()).inverse();
    return {X / n, x / n, v / n, (xX - x * X.transpose() / n) * inverse,
            (vX - v * X.transpose() / n) * inverse};
  }
};

/// Mean squares of how far particles are from a map: of their places, and of their velocities.
struct Residual {
  double x = 0, v = 0;
};

}  // namespace

struct DynamicGroups::Unit {
  std::int32_t cell = 0;
  int part = -1;
  bool was_grouped = true;
  std::int32_t group = -1;  ///< that it joins
  bool fits = false;
  Sums sums;
  AffineMap map;
  Residual own;

  /// From another map.
  Residual from(const AffineMap& other) const {
    const Mat3 S = sums.spread() / sums.n, dF = map.F - other.F, dV = map.V - other.V;
    const Vec3 to = map.center - other.center;
    const Vec3 dc = map.c - (other.c + other.F * to), dv = map.v - (other.v + other.V * to);
    return {own.x + dc.squaredNorm() + (dF * S).cwiseProduct(dF).sum(),
            own.v + dv.squaredNorm() + (dV * S).cwiseProduct(dV).sum()};
  }
};

DynamicGroups::DynamicGroups(std::shared_ptr<const Body> body, Motion motion, double mass,
                             const DynamicOptions& options)
    : body_(std::move(body)),
      motion_(std::move(motion)),
      options_(options),
      most_held_(options.tolerance * body_->material.pair.r * stiffness_of_place *
                 body_->material.stiffness() / mass),
      cell_(body_->rest.size()) {
  const double edge = cell_edge * 2 * body_->material.pair.r;
  Box box;
  for (const Vec3& X : body_->rest) box.extend(Vec3(body_->lattice.transpose() * X));
  count_ = 1;
  for (int axis = 0; axis < 3; ++axis) {
    cells_along_[axis] =
        box.isEmpty() ? 1 : 1 + static_cast<std::int32_t>(box.sizes()[axis] / edge);
    count_ *= static_cast<std::size_t>(cells_along_[axis]);
  }
  for (std::size_t i = 0; i < cell_.size(); ++i) {
    const Vec3 from = (body_->lattice.transpose() * body_->rest[i] - box.min()) / edge;
    std::int32_t cell = 0;
    for (int axis = 2; axis >= 0; --axis)
      cell = cell * cells_along_[axis] +
             std::min(static_cast<std::int32_t>(from[axis]), cells_along_[axis] - 1);
    cell_[i] = cell;
  }
}

/// Joints that leave, until some time ahead, where they have been still; or where they are now.
std::vector<bool> DynamicGroups::moving(const GroupingMoment& now, double ahead) const {
  const std::size_t bones = body_->skeleton.size();
  std::vector<double> since(bones, now.time);
  for (std::size_t b = 0; b < now.still_since.size(); ++b)
    if (now.still_since[b] >= 0) since[b] = now.still_since[b];
  std::vector<double> distinct = since;
  std::sort(distinct.begin(), distinct.end());
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  std::vector<bool> moves(bones, false);
  for (const double begun : distinct) {
    const std::vector<bool> found =
        moving_joints(body_->skeleton, motion_, pose_at(body_->skeleton, motion_, begun),
                      {now.time, now.time + ahead}, moments_ahead);
    for (std::size_t b = 0; b < bones; ++b)
      if (since[b] == begun) moves[b] = found[b];
  }
  return moves;
}

bool DynamicGroups::is_held_above(double share, const HeldCell& cell) const {
  const double most = share * most_held_;
  return cell.squares > most * most * cell.count;
}

bool DynamicGroups::must_split(const GroupingMoment& now, std::span<const HeldCell> held) const {
  if (std::any_of(held.begin(), held.end(),
                  [&](const HeldCell& cell) { return is_held_above(1, cell); }))
    return true;
  const std::vector<bool> moves = moving(now, now.interval);
  for (std::size_t b = 0; b < moves.size(); ++b)
    if (moves[b] && now.still_since[b] >= 0) return true;
  return false;
}

/// 1 for cells that are held too strongly, or soon will be, and those around them.
std::vector<std::uint8_t> DynamicGroups::torn_around(std::span<const HeldCell> held) const {
  std::vector<std::uint8_t> torn(count_, 0);
  const auto& [nx, ny, nz] = cells_along_;
  for (std::int32_t cell = 0; cell < static_cast<std::int32_t>(held.size()); ++cell) {
    if (!is_held_above(torn_share, held[static_cast<std::size_t>(cell)])) continue;
    const std::int32_t x = cell % nx, y = cell / nx % ny, z = cell / (nx * ny);
    for (std::int32_t k = std::max(z - 1, 0); k <= std::min(z + 1, nz - 1); ++k)
      for (std::int32_t j = std::max(y - 1, 0); j <= std::min(y + 1, ny - 1); ++j)
        for (std::int32_t i = std::max(x - 1, 0); i <= std::min(x + 1, nx - 1); ++i)
          torn[static_cast<std::size_t>((k * ny + j) * nx + i)] = 1;
  }
  return torn;
}

/// The units, in the order of their cells and parts, and that of each particle, by id: -1 where it
/// follows no part.
std::vector<std::int32_t> DynamicGroups::find_units(const BoneParts& parts, Units& units) const {
  std::vector<std::int64_t> key(cell_.size(), -1);
  // What no bone holds is a part as well.
  const auto bones = static_cast<int>(body_->skeleton.size());
  const std::int64_t of_cell = bones + 1;
  parallel_for(key.size(), particles_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (const int part = parts.of(i); part != BoneParts::none)
        key[i] = cell_[i] * of_cell + (part == BoneParts::without_bones ? bones : part);
  });
  std::vector<std::int64_t> keys;
  for (const std::int64_t one : key)
    if (one >= 0 && (keys.empty() || keys.back() != one)) keys.push_back(one);
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  units.resize(keys.size());
  for (std::size_t u = 0; u < keys.size(); ++u) {
    units[u].cell = static_cast<std::int32_t>(keys[u] / of_cell);
    units[u].part = static_cast<int>(keys[u] % of_cell);
  }
  std::vector<std::int32_t> unit(key.size(), -1);
  parallel_for(key.size(), particles_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (key[i] >= 0)
        unit[i] = static_cast<std::int32_t>(std::lower_bound(keys.begin(), keys.end(), key[i]) -
                                            keys.begin());
  });
  return unit;
}

/// Fits each unit, and how far its particles are from that.
void DynamicGroups::measure(const Particles& particles, std::span<const std::int32_t> unit,
                            Units& units) const {
  const Vec3 origin = body_->rest.empty() ? Vec3(Vec3::Zero()) : body_->rest.front();
  std::vector<std::uint32_t> place(particles.size());
  for (std::uint32_t k = 0; k < place.size(); ++k)
    place[static_cast<std::size_t>(particles.id[k])] = k;
  const auto for_each = [&](const auto& visit) {  // by id: whatever their order
    for (std::size_t i = 0; i < unit.size(); ++i)
      if (unit[i] >= 0)
        visit(units[static_cast<std::size_t>(unit[i])], i, body_->rest[i] - origin,
              particles.position(place[i]) - origin, particles.velocity(place[i]));
  };
  for_each([&](Unit& one, std::size_t i, const Vec3& X, const Vec3& x, const Vec3& v) {
    one.sums.add(X, x, v);
    one.was_grouped = one.was_grouped && body_->grouping->group[i] >= 0;
  });
  for (Unit& one : units) one.map = one.sums.map();
  for_each([](Unit& one, std::size_t, const Vec3& X, const Vec3& x, const Vec3& v) {
    const Vec3 from = X - one.map.center;
    one.own.x += (x - one.map.c - one.map.F * from).squaredNorm() / one.sums.n;
    one.own.v += (v - one.map.v - one.map.V * from).squaredNorm() / one.sums.n;
  });
}

/// Grows groups from one unit after another, as long as the next one moves with them.
void DynamicGroups::grow(const GroupingMoment& now, Units& units) const {
  const double tolerance = options_.tolerance * body_->material.pair.r;
  const auto moves_with = [&](const Unit& one, const AffineMap& map) {
    const double most = (one.was_grouped ? 1 : free_share) * tolerance;
    const Residual off = one.from(map);
    return off.x < most * most && off.v * now.interval * now.interval < most * most;
  };
  for (Unit& one : units) one.fits = one.fits && moves_with(one, one.map);
  std::vector<std::vector<std::size_t>> at(count_);
  std::vector<std::size_t> seeds;
  for (std::size_t u = 0; u < units.size(); ++u)
    at[static_cast<std::size_t>(units[u].cell)].push_back(u), seeds.push_back(u);
  std::stable_sort(seeds.begin(), seeds.end(), [&](std::size_t a, std::size_t b) {
    return units[a].was_grouped > units[b].was_grouped;
  });
  const auto& [nx, ny, nz] = cells_along_;
  const std::int32_t steps[3] = {1, nx, nx * ny};
  std::int32_t next = 0;
  const auto grow_from = [&](std::size_t seed) {
    std::vector<std::size_t> members{seed};
    Sums sums = units[seed].sums;
    AffineMap map = units[seed].map;
    units[seed].group = next;
    for (std::size_t n = 0; n < members.size(); ++n) {
      const std::int32_t cell = units[members[n]].cell;
      const std::int32_t along[3] = {cell % nx, cell / nx % ny, cell / (nx * ny)};
      for (int side = 0; side < 6; ++side) {
        const int axis = side / 2, by = side % 2 == 0 ? 1 : -1;
        if (along[axis] + by < 0 || along[axis] + by >= cells_along_[axis]) continue;
        for (const std::size_t u : at[static_cast<std::size_t>(cell + by * steps[axis])]) {
          Unit& other = units[u];
          if (other.group >= 0 || !other.fits || other.part != units[seed].part) continue;
          if (!moves_with(other, map)) continue;
          other.group = next;
          members.push_back(u);
          sums += other.sums;
          map = sums.map();
        }
      }
    }
    bool all = true;
    for (const std::size_t u : members)
      if (!moves_with(units[u], map)) units[u].group = -1, all = false;
    ++next;
    return all;
  };
  for (int round = 0; round < most_rounds; ++round) {
    bool all = true;
    for (const std::size_t seed : seeds)
      if (units[seed].fits && units[seed].group < 0) all = grow_from(seed) && all;
    if (all) break;
  }
}

NewGroups DynamicGroups::regroup(const GroupingMoment& now, std::span<const HeldCell> held,
                                 const Particles& particles) const {
  const std::vector<bool> moves = moving(now, checks_ahead * now.interval);
  const BoneParts parts(*body_, moves, options_.joint_distance);
  Units units;
  const std::vector<std::int32_t> unit = find_units(parts, units);
  measure(particles, unit, units);
  const std::vector<std::uint8_t> torn = torn_around(held);
  for (Unit& one : units) one.fits = torn[static_cast<std::size_t>(one.cell)] == 0;
  grow(now, units);
  NewGroups made{std::vector<std::int32_t>(unit.size(), -1), now.still_since};
  for (std::size_t i = 0; i < unit.size(); ++i)
    if (unit[i] >= 0) made.group[i] = units[static_cast<std::size_t>(unit[i])].group;
  separate(*body_, options_.least, made.group);
  made.still_since.resize(moves.size(), -1);
  for (std::size_t b = 0; b < moves.size(); ++b) {
    double& since = made.still_since[b];
    since = moves[b] ? -1 : since < 0 ? now.time : since;
  }
  return made;
}

}  // namespace sinew
