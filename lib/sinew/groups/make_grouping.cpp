// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/groups/make_grouping.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <span>

#include <sinew/body/body.h>
#include <sinew/core/cell_grid.h>
#include <sinew/core/decompositions.h>
#include <sinew/core/error.h>
#include <sinew/core/parallel.h>
#include <sinew/core/particles.h>
#include <sinew/groups/affine/affine_forces.h>
#include <sinew/groups/cubic/cubic_fits.h>
#include <sinew/groups/cubic/quadrature.h>
#include <sinew/material/laws.h>
#include <sinew/world/features.h>
#include <sinew/world/world.h>

namespace sinew {
namespace {

constexpr std::size_t particles_per_layering = 8192;
constexpr double off_center = 1e-6;  // in radii: above rounding of files' coordinates
// Mean squares of X along the thinnest direction, in r^2: of two layers it is 0.5 and more.
constexpr double thinnest = 0.4;

constexpr std::size_t enough_places = 2048;  // to tell sheets

constexpr std::uint8_t unknown = 255, max_levels = 8;
constexpr int faces_of_level = 6;

bool holds_seconds(const Body& body) { return body.material.bond.second > 0; }

/// Forces on a particle that depend on its neighbors' neighbors.
bool reaches_far(const Body& body) {
  return keeps_volume(body) ||
         (body.material.damping_form != DampingForm::paper && body.material.damping > 0);
}

class LayerFinder {
 public:
  LayerFinder(const Body& body, const std::vector<std::int32_t>& group, SharedNeighbors near)
      : body_(body),
        group_(group),
        r_(body.material.pair.r),
        whole_(holds_seconds(body) ? near_sites : nearest_sites),
        by_sites_(supports_cubic_groups(body)),
        shared_(std::move(near)),
        near_(holds_seconds(body) ? shared_->all() : shared_->nearest) {
    if (has_affine_forces(body)) affine_.emplace(body);
  }

  void fill(Grouping& out) const {
    const std::vector<std::uint8_t> centers = balanced();
    out.layer = layers(centers);
    out.face = faces(out.layer);
    for (std::size_t i = 0; i < centers.size(); ++i)
      out.skin.push_back(out.layer[i] >= Layer::shell && centers[i] == 0 ? 1 : 0);
  }

 private:
  /// 1 where all forces between neighbors of a group add up to zero.
  std::vector<std::uint8_t> balanced() const {
    const auto centers =
        marked([&](std::uint32_t i, const auto& near) { return is_center(i, near); });
    return reaches_far(body_) ? marked_where_all(centers) : centers;
  }

  std::vector<Layer> layers(const std::vector<std::uint8_t>& centers) const {
    std::vector<std::uint8_t> inner = marked([&](std::uint32_t i, const auto& near) {
      return ((centers[i] != 0 && !by_sites_) || has_sites(i, near)) &&
             all(near, [&](auto j) { return group_[j] == group_[i]; });
    });
    if (reaches_far(body_)) inner = marked_where_all(inner);
    std::vector<std::uint8_t> deep = marked_where_all(inner);
    if (reaches_far(body_)) deep = marked_where_all(deep);
    std::vector<Layer> layers(group_.size());
    for (std::size_t i = 0; i < layers.size(); ++i)
      layers[i] = group_[i] < 0   ? Layer::free
                  : inner[i] == 0 ? Layer::rim
                  : deep[i] == 0  ? Layer::shell
                                  : Layer::core;
    return layers;
  }

  /// Half-planes from the outside in: each particle's level is one above its neighbors' lowest.
  std::vector<std::uint8_t> faces(const std::vector<Layer>& layer) const {
    std::vector<std::uint8_t> level(group_.size(), unknown), face(group_.size(), 0);
    for (std::uint8_t now = 0; now < max_levels; ++now) {
      const auto reached = marked([&](std::uint32_t i, const auto& near) {
        if (level[i] != unknown || layer[i] == Layer::core) return false;
        Vec3 inwards = Vec3::Zero();
        std::size_t inside = 0;
        for (const std::uint32_t j : near) {
          const Vec3 to = body_.rest[j] - body_.rest[i];
          if (group_[j] != group_[i] || level[j] != unknown || !is_nearest(to)) continue;
          inwards += to, ++inside;
        }
        if (inside == 12) return false;
        face[i] = static_cast<std::uint8_t>(faces_of_level * now + face_of(inwards));
        return true;
      });
      for (std::size_t i = 0; i < level.size(); ++i)
        if (reached[i] != 0) level[i] = now;
    }
    return face;
  }

  /// Returns the face of particles whose neighbors farther in lie in this direction.
  std::uint8_t face_of(const Vec3& inwards) const {
    const Vec3 along = (body_.lattice.transpose() * inwards / r_).array().round();
    int axis = 0;
    along.cwiseAbs().maxCoeff(&axis);
    return static_cast<std::uint8_t>(2 * axis + (along[axis] > 0 ? 0 : 1));
  }

  bool is_nearest(const Vec3& X) const { return X.norm() < rest_neighbor_range(r_); }

  template <class Range, class Holds>
  static bool all(const Range& range, const Holds& holds) {
    return std::all_of(range.begin(), range.end(), holds);
  }

  /// 1 for the grouped particles for which holds(i, neighbors).
  template <class Holds>
  std::vector<std::uint8_t> marked(const Holds& holds) const {
    std::vector<std::uint8_t> marks(group_.size(), 0);
    parallel_for(marks.size(), particles_per_layering, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        if (group_[i] >= 0) marks[i] = holds(static_cast<std::uint32_t>(i), near_.of(i)) ? 1 : 0;
    });
    return marks;
  }

  /// Keeps the marks of particles with only marked neighbors.
  std::vector<std::uint8_t> marked_where_all(const std::vector<std::uint8_t>& before) const {
    return marked([&](std::uint32_t i, const auto& near) {
      return before[i] != 0 && all(near, [&](auto j) { return before[j] != 0; });
    });
  }

  /// Whether the neighbors of a particle are all there, opposite to each other, with equal bonds.
  bool is_center(std::uint32_t i, std::span<const std::uint32_t> near) const {
    if (near.size() != whole_ || !body_.factors.of(i).empty()) return false;
    const Vec3& here = body_.rest[i];
    return all(near, [&](std::uint32_t j) {
      const Vec3 opposite = 2 * here - body_.rest[j];
      return std::any_of(near.begin(), near.end(), [&](std::uint32_t k) {
        return (body_.rest[k] - opposite).squaredNorm() < off_center * off_center * r_ * r_ &&
               keep_volume_alike(j, k);
      });
    });
  }

  bool keep_volume_alike(std::uint32_t j, std::uint32_t k) const {
    const auto stiffness = [&](std::uint32_t i) {
      return value_at(body_.factors.volume_weight, i, 1) *
             value_at(body_.local.volume, i, body_.material.volume_stiffness);
    };
    return std::abs(stiffness(j) - stiffness(k)) <= off_center * stiffness(j);
  }

  /// Whether forces on a particle would follow from a group's motion.
  bool has_sites(std::uint32_t i, std::span<const std::uint32_t> near) const {
    return affine_ && all(near, [&](std::uint32_t j) {
             return affine_->site_of(body_.rest[j] - body_.rest[i]) >= 0;
           });
  }

  const Body& body_;
  const std::vector<std::int32_t>& group_;
  double r_;
  std::size_t whole_;
  bool by_sites_;  ///< cubic groups know bonds by their sites
  SharedNeighbors shared_;
  const NeighborLists& near_;
  std::optional<AffineForces> affine_;
};

/// Sums over the particles of a group.
struct Moments {
  double count = 0;
  Vec3 x = Vec3::Zero();
  Mat3 xx = Mat3::Zero();

  void add(const Vec3& at) { count += 1, x += at, xx += at * at.transpose(); }
  bool is_thick(double r) const {
    const Vec3 mean = x / count;
    const Mat3 spread = xx / count - mean * mean.transpose();
    return eigenvalues(spread)[0] > thinnest * r * r;
  }
};

/// Frees what is too thin, and numbers the others in order.
void renumber(const Body& body, std::vector<std::int32_t>& group, Grouping& out) {
  const Vec3 origin = body.rest.empty() ? Vec3(Vec3::Zero()) : body.rest.front();
  std::map<std::int32_t, Moments> moments;
  for (std::size_t i = 0; i < group.size(); ++i)
    if (group[i] >= 0) moments[group[i]].add(body.rest[i] - origin);
  std::map<std::int32_t, std::int32_t> number;
  for (std::int32_t& one : group) {
    if (one < 0 || !moments[one].is_thick(body.material.pair.r)) {
      one = -1;
      continue;
    }
    const auto [at, added] = number.try_emplace(one, static_cast<std::int32_t>(out.sizes.size()));
    if (added) out.sizes.push_back(0);
    one = at->second;
    ++out.sizes[static_cast<std::size_t>(one)];
  }
}

/// Some places of each group.
std::map<std::int32_t, Points> samples(const Body& body, const std::vector<std::int32_t>& group) {
  std::map<std::int32_t, std::size_t> sizes, met;
  for (const std::int32_t one : group)
    if (one >= 0) ++sizes[one];
  std::map<std::int32_t, Points> places;
  for (std::size_t i = 0; i < group.size(); ++i)
    if (group[i] >= 0 &&
        is_sample(met[group[i]]++, std::max<std::size_t>(sizes[group[i]] / enough_places, 1)))
      places[group[i]].push_back(body.rest[i]);
  return places;
}

bool is_sheet(const Points& places) {
  const FitFrame frame(places);
  TermProducts products = TermProducts::Zero();
  for (const Vec3& X : places)
    products += terms_at(frame.at(X)) * terms_at(frame.at(X)).transpose();
  return !tells_apart(products);
}

void find_cubic(const Body& body, const std::vector<std::int32_t>& group, std::size_t from,
                Grouping& out) {
  for (const auto& [of, places] : samples(body, group)) {
    const auto g = static_cast<std::size_t>(of);
    if (out.sizes[g] >= from && !is_sheet(places)) out.cubic[g] = 1;
  }
}

}  // namespace

Grouping make_grouping(const Body& body, std::vector<std::int32_t> group, std::size_t cubic_from,
                       SharedNeighbors near) {
  Grouping made;
  renumber(body, group, made);
  LayerFinder(body, group, near ? std::move(near) : neighbors_of(body)).fill(made);
  made.cubic.assign(made.size(), 0);
  if (cubic_from != none_cubic) find_cubic(body, group, cubic_from, made);
  made.group = std::move(group);
  return made;
}

void free_sheets(const Body& body, std::vector<std::int32_t>& group) {
  const std::map<std::int32_t, Points> all = samples(body, group);
  std::map<std::int32_t, bool> sheets;
  for (const auto& [g, places] : all) sheets[g] = is_sheet(places);
  for (std::int32_t& one : group)
    if (one >= 0 && sheets[one]) one = -1;
}

StretchRange stretch_range(const Body& body) {
  const double r = body.material.pair.r;
  const ForceLaw& law = law_of(body.material);
  const double lasts = law.has_bonds || !has_affine_forces(body)
                           ? std::numeric_limits<double>::infinity()
                           : body.material.pair.b / nearest_distance(r);
  const double least = law.range(body.material) / second_distance(r);
  const double third_distance = std::sqrt(3) * nearest_distance(r);
  return {least, holds_seconds(body) ? 2 * r / third_distance : least, lasts};
}

bool groups_are_built() { return true; }

bool supports_cubic_groups(const Body& body) {
  return law_of(body.material).has_bonds && has_affine_forces(body) && !keeps_volume(body);
}

void check_groupable(const Body& body) { refuse_conflicts(Feature::groups, features_of(body)); }

void check_groupable_as_it_moves(const Body& body) {
  check_groupable(body);
  if (!body.world || body.world->obstacles.empty()) return;
  for (std::size_t i = 0; i < body.rest.size(); ++i)
    if (body.binding.of(i).empty())
      throw bad_input("where obstacle '" + body.world->obstacles.front().name +
                          "' will press particles that no bone holds is not known, and groups do "
                          "not yield there",
                      "set hierarchy.dynamic to false, or bind all particles to bones");
}

}  // namespace sinew
