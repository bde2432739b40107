// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/groups/dynamic/dynamic_groups.h>

#include <algorithm>
#include <functional>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include <sinew/body/body.h>
#include <sinew/core/parallel.h>
#include <sinew/groups/static_groups.h>

namespace sinew {
namespace {

constexpr double cell_edge = 8;  // diameters
constexpr std::size_t particles_per_count = 8192;
constexpr int moments_ahead = 16;
// Groups are worth the work of making them if no joint of theirs moves for so many checks.
constexpr double checks_ahead = 16;
constexpr int max_rounds = 4;  // rounds of what is grown and found not to fit
// Fraction of how far off the worst is, squared, from which on others leave with it.
constexpr double leaving_fraction = 0.25;
constexpr double free_fraction = 0.5;  // fraction of the tolerance, for what was free
constexpr double torn_fraction = 0.5;  // fraction of the tolerance: what leaves where some must
// Stiffness against moving a particle while its neighbors stay, in stiffnesses of a bond.
constexpr double stiffness_of_place = 4;

/// Units of one assembly that move by one cubic.
class CubicGrowth {
 public:
  /// `relative_residual`: of a unit, of what it may be off a motion.
  CubicGrowth(const std::vector<CubicSums>& sums, double least,
              std::function<double(std::size_t, const CubicMotion&)> relative_residual)
      : sums_(sums),
        least_(least),
        relative_residual_of_(std::move(relative_residual)),
        taken_(sums.size(), 0) {}

  /// Whether those for which is_one(unit) holds move by one.
  template <class IsOne>
  bool all_fit(const IsOne& is_one) {
    choose(is_one);
    return fit() && worst() < 1;
  }
  /// Takes the units of those that do and are in no group yet, and others that move with them, if
  /// they are enough.
  template <class IsOne>
  std::vector<std::size_t> grow(const IsOne& is_one) {
    std::vector<std::size_t> grown;
    choose(is_one);
    if (!shrink()) return grown;
    for (std::size_t n = 0; n < in_.size(); ++n)
      if (taken_[n] == 0 && relative_residual_[n] < 1) in_[n] = 1;
    if (!shrink()) return grown;
    for (std::size_t n = 0; n < in_.size(); ++n)
      if (in_[n] != 0) grown.push_back(n), taken_[n] = 1;
    return grown;
  }

 private:
  template <class IsOne>
  void choose(const IsOne& is_one) {
    in_.assign(sums_.size(), 0), relative_residual_.assign(sums_.size(), 0);
    for (std::size_t n = 0; n < in_.size(); ++n) in_[n] = taken_[n] == 0 && is_one(n) ? 1 : 0;
  }
  /// Whether there is a motion.
  bool fit() {
    CubicSums all;
    for (std::size_t n = 0; n < in_.size(); ++n)
      if (in_[n] != 0) all += sums_[n];
    if (all.n < least_) return false;
    const std::optional<CubicMotion> motion = cubic_motion(all);
    for (std::size_t n = 0; motion && n < in_.size(); ++n)
      relative_residual_[n] = relative_residual_of_(n, *motion);
    return motion.has_value();
  }
  double worst() const {
    double worst = 0;
    for (std::size_t n = 0; n < in_.size(); ++n)
      if (in_[n] != 0) worst = std::max(worst, relative_residual_[n]);
    return worst;
  }
  /// What moves least so leaves, until all do.
  bool shrink() {
    while (fit()) {
      const double most = worst();
      if (most < 1) return true;
      for (std::size_t n = 0; n < in_.size(); ++n)
        if (relative_residual_[n] >= std::max(1.0, leaving_fraction * most)) in_[n] = 0;
    }
    return false;
  }

  const std::vector<CubicSums>& sums_;
  double least_;
  std::function<double(std::size_t, const CubicMotion&)> relative_residual_of_;
  std::vector<std::uint8_t> taken_, in_;
  std::vector<double> relative_residual_;
};

}  // namespace

DynamicGroups::DynamicGroups(std::shared_ptr<const Body> body, Motion motion, double mass,
                             const DynamicOptions& options)
    : body_(std::move(body)),
      motion_(std::move(motion)),
      options_(options),
      max_constraint_(options.tolerance * body_->material.pair.r * stiffness_of_place *
                      body_->material.stiffness() / mass),
      near_(options_.near ? options_.near : neighbors_of(*body_)),
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

bool DynamicGroups::is_constrained_above(double fraction, const ConstrainedCell& cell) const {
  const double most = fraction * max_constraint_;
  return cell.squares > most * most * cell.count;
}

/// Returns the fraction of what a unit may be off, squared, to stay or, where it was free, to join.
double DynamicGroups::relative_residual(const GroupingMoment& now, bool was_grouped,
                                        const Residual& off) const {
  const double most =
      (was_grouped ? 1 : free_fraction) * options_.tolerance * body_->material.pair.r;
  return std::max(off.x, off.v * now.interval * now.interval) / (most * most);
}

bool DynamicGroups::must_split(const GroupingMoment& now,
                               std::span<const ConstrainedCell> constrained) const {
  if (std::any_of(constrained.begin(), constrained.end(),
                  [&](const ConstrainedCell& cell) { return is_constrained_above(1, cell); }))
    return true;
  const std::vector<bool> moves = moving(now, now.interval);
  for (std::size_t b = 0; b < moves.size(); ++b)
    if (moves[b] && now.still_since[b] >= 0) return true;
  return false;
}

/// 1 for cells that groups constrain too strongly, with those around them, or soon will be.
std::vector<std::uint8_t> DynamicGroups::torn_around(
    std::span<const ConstrainedCell> constrained) const {
  std::vector<std::uint8_t> torn(count_, 0);
  const auto& [nx, ny, nz] = cells_along_;
  for (std::int32_t cell = 0; cell < static_cast<std::int32_t>(constrained.size()); ++cell) {
    const ConstrainedCell& at = constrained[static_cast<std::size_t>(cell)];
    if (is_constrained_above(torn_fraction, at)) torn[static_cast<std::size_t>(cell)] = 1;
    if (!is_constrained_above(1, at)) continue;
    const std::int32_t x = cell % nx, y = cell / nx % ny, z = cell / (nx * ny);
    for (std::int32_t k = std::max(z - 1, 0); k <= std::min(z + 1, nz - 1); ++k)
      for (std::int32_t j = std::max(y - 1, 0); j <= std::min(y + 1, ny - 1); ++j)
        for (std::int32_t i = std::max(x - 1, 0); i <= std::min(x + 1, nx - 1); ++i)
          torn[static_cast<std::size_t>((k * ny + j) * nx + i)] = 1;
  }
  return torn;
}

/// Grows groups from one unit after another, as long as the next one moves with them.
void DynamicGroups::grow(const GroupingMoment& now, std::vector<Unit>& units) const {
  const auto moves_with = [&](const Unit& one, const AffineMap& map) {
    return relative_residual(now, one.was_grouped(), one.from(map)) < 1;
  };
  for (Unit& one : units) one.fits = one.fits && moves_with(one, one.map);
  std::vector<std::vector<std::size_t>> at(count_);
  std::vector<std::size_t> seeds;
  for (std::size_t u = 0; u < units.size(); ++u)
    at[static_cast<std::size_t>(units[u].cell)].push_back(u), seeds.push_back(u);
  std::stable_sort(seeds.begin(), seeds.end(), [&](std::size_t a, std::size_t b) {
    return units[a].was_grouped() > units[b].was_grouped();
  });
  const std::int32_t nx = cells_along_[0], ny = cells_along_[1];
  const std::int32_t steps[3] = {1, nx, nx * ny};
  std::int32_t next = 0;
  const auto grow_from = [&](std::size_t seed) {
    std::vector<std::size_t> members{seed};
    AffineSums sums = units[seed].sums;
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
          if (other.group >= 0 || !other.fits || other.assembly != units[seed].assembly) continue;
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
  for (int round = 0; round < max_rounds; ++round) {
    bool all = true;
    for (const std::size_t seed : seeds)
      if (units[seed].fits && units[seed].group < 0) all = grow_from(seed) && all;
    if (all) break;
  }
}

/// Groups units of each assembly that move by cubics: those of a group before, or of all of its
/// groups, as far as they still do, and what moves with them; then what is left.
void DynamicGroups::bend(const GroupingMoment& now, MovingUnits& units) const {
  std::map<int, std::vector<std::size_t>> assemblies;
  for (std::size_t u = 0; u < units.all().size(); ++u)
    if (units.all()[u].fits) assemblies[units.all()[u].assembly].push_back(u);
  std::int32_t next = 0;
  for (const auto& assembly : assemblies) {
    const std::vector<std::size_t>& of = assembly.second;
    const std::vector<CubicSums> sums = units.cubic_sums(of);
    const auto unit = [&](std::size_t n) -> Unit& { return units.all()[of[n]]; };
    const auto least = static_cast<double>(options_.sizes.min_cubic);
    CubicGrowth growth(sums, least, [&](std::size_t n, const CubicMotion& motion) {
      return relative_residual(now, unit(n).was_grouped(), residual(sums[n], motion));
    });
    std::set<std::int32_t> before;
    for (std::size_t n = 0; n < of.size(); ++n) before.insert(unit(n).was_in);
    before.erase(-1);
    const auto from = [&](const auto& is_one) {
      for (const std::size_t n : growth.grow(is_one)) unit(n).group = next;
      ++next;
    };
    const auto was_grouped = [&](std::size_t n) { return unit(n).was_grouped(); };
    if (before.size() > 1 && growth.all_fit(was_grouped)) from(was_grouped);
    for (const std::int32_t one : before)
      from([&](std::size_t n) { return unit(n).was_in == one; });
    from([](std::size_t) { return true; });
  }
}

/// Whether so many free particles follow an assembly that groups may be worth making anew.
bool DynamicGroups::may_join(const GroupingMoment& now, std::size_t enough) const {
  const std::vector<bool> moves = moving(now, checks_ahead * now.interval);
  const GroupSizes& sizes = options_.sizes;
  const BoneAssemblies assemblies(
      *body_, moves, sizes.cubic_distance.value_or(sizes.joint_distance), sizes.kept_free);
  std::vector<std::size_t> found((cell_.size() + particles_per_count - 1) / particles_per_count);
  parallel_for(cell_.size(), particles_per_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (body_->grouping->group[i] < 0 && assemblies.of(i) != BoneAssemblies::none)
        ++found[begin / particles_per_count];
  });
  return std::accumulate(found.begin(), found.end(), std::size_t{0}) >= enough;
}

/// Adds what is in no group, to new ones, numbered from `first` on.
void DynamicGroups::add_groups(Asked& asked, bool cubic, std::int32_t first,
                               std::vector<std::int32_t>& group) const {
  const GroupSizes& sizes = options_.sizes;
  const BoneAssemblies assemblies(
      *body_, asked.moves, cubic ? *sizes.cubic_distance : sizes.joint_distance, sizes.kept_free);
  MovingUnits units(*body_, cell_, assemblies, group, asked.particles);
  for (Unit& one : units.all())
    one.fits =
        asked.torn[static_cast<std::size_t>(one.cell)] == 0 && !asked.bend.contains(one.assembly);
  if (cubic)
    bend(asked.now, units);
  else
    grow(asked.now, units.all());
  for (std::size_t u = 0; u < units.all().size(); ++u)
    if (const std::int32_t joined = units.all()[u].group; joined >= 0)
      for (const std::uint32_t i : units.members(u)) group[i] = first + joined;
  separate(near_->nearest, cubic ? sizes.min_cubic : sizes.min_particles, group);
  if (!cubic) return;
  free_sheets(*body_, group);
  for (std::size_t u = 0; u < units.all().size(); ++u)
    if (group[units.members(u).front()] >= 0) asked.bend.insert(units.all()[u].assembly);
}

NewGroups DynamicGroups::regroup(const GroupingMoment& now,
                                 std::span<const ConstrainedCell> constrained,
                                 const Particles& particles) const {
  const std::vector<bool> moves = moving(now, checks_ahead * now.interval);
  const std::vector<std::uint8_t> torn = torn_around(constrained);
  NewGroups made{std::vector<std::int32_t>(cell_.size(), -1), now.still_since};
  Asked asked{now, moves, torn, particles, {}};
  if (options_.sizes.cubic_distance) add_groups(asked, true, 0, made.group);
  add_groups(asked, false, static_cast<std::int32_t>(cell_.size()), made.group);
  made.still_since.resize(moves.size(), -1);
  for (std::size_t b = 0; b < moves.size(); ++b) {
    double& since = made.still_since[b];
    since = moves[b] ? -1 : since < 0 ? now.time : since;
  }
  return made;
}

}  // namespace sinew
