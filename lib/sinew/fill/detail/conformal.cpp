// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/fill/detail/conformal.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/cell_grid.h>
#include <sinew/core/error.h>
#include <sinew/core/parallel.h>
#include <sinew/core/particles.h>
#include <sinew/fill/detail/relax.h>
#include <sinew/mesh/surface_distance.h>
#include <sinew/mesh/winding.h>

namespace sinew {
namespace {

// Layers of a closest packing are this far apart, in radii: those that have their sites within it
// of the surface make one layer, but for those that have no room there.
const double layer = std::sqrt(8.0 / 3);
constexpr double room = 1.75;      // radii, least distance of two particles of the layer
constexpr double deeper = 0.8;     // radii
constexpr double behind = 1;       // radii from the layer to particles that it has no room for
constexpr double moved_along = 6;  // radii below the surface, to where particles may move
constexpr double stiffness = 3;    // stiffness of the outer layer's springs over that of a pair
constexpr int rounds = 40, steps_of_each = 10;  // the surface is looked for in each round
constexpr std::size_t particles_at_a_time = 256;

void refuse(const BodySpace& space, const PackOptions& options, const FilledSites& filled) {
  const auto refused = [](const char* what, const char* cure) {
    return bad_input(std::string("a conformal packing follows one closed surface, and ") + what,
                     cure);
  };
  if (options.thickness)
    throw refused("a layer along the surface is to be filled",
                  "leave the thickness out, or give another packing");
  if (!space.surface.closed())
    throw refused("this one has holes", "close them (close_holes), or give another packing");
  if (filled.inside.deepest > 1)
    throw refused("parts of this one overlap", "wrap it (wrap), or give another packing");
}

/// What the surface is to a particle nearby: a plane.
struct Plane {
  Vec3 normal = Vec3::Zero();  ///< outward; 0: too far to matter
  double height = 0;           ///< distance of the surface along it, m
};

class OuterLayer {
 public:
  OuterLayer(const Surface& surface, const Points& places, double radius, double first_depth)
      : surface_(surface),
        r_(radius),
        offset_(first_depth + layer / 2 * radius),
        planes_(places.size()),
        outermost_(places.size()),
        deep_(places.size()) {
    find(places);
    std::vector<double> depth(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
      depth[i] = depth_of(i, places[i]);
      deep_[i] = depth[i] > first_depth + moved_along * r_ ? 1 : 0;
    }
    choose_outermost(places, depth, first_depth + layer * r_);
  }

  const std::vector<char>& deep() const { return deep_; }

  /// Planes at the particles' present places.
  void find(const Points& places) {
    parallel_for(places.size(), particles_at_a_time, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (deep_[i] != 0) continue;
        const NearestPlace nearest = surface_.from(places[i]);
        planes_[i] = {nearest.normal, nearest.normal.dot(places[i]) - nearest.distance};
      }
    });
  }

  /// Over that of a pair at d = 0.
  Vec3 force(std::size_t i, const Vec3& place) const {
    const double rise = (depth_of(i, place) - offset_) / (2 * r_);
    if (outermost_[i] != 0) return stiffness * rise * planes_[i].normal;
    return stiffness * std::min(rise - behind / 2, 0.0) * planes_[i].normal;
  }

 private:
  /// Chooses, from the surface inward, those that have room on the offset surface.
  void choose_outermost(const Points& places, const std::vector<double>& depth, double deepest) {
    std::vector<std::uint32_t> order;
    Points on_it = places;
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (depth[i] < deepest) order.push_back(static_cast<std::uint32_t>(i));
      on_it[i] += (depth[i] - offset_) * planes_[i].normal;
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return depth[a] < depth[b]; });
    const std::vector<char> backed = find_backed(places, depth);
    const CellGrid grid(on_it, room * r_);
    for (const std::uint32_t i : order) {
      bool has_room = backed[i] != 0;
      grid.for_each_near(on_it[i], [&](std::uint32_t j) {
        has_room = has_room && (outermost_[j] == 0 || (on_it[i] - on_it[j]).norm() > room * r_);
      });
      outermost_[i] = has_room ? 1 : 0;
    }
  }

  /// Marks those with others deeper in the body beside them: where it is a particle or two thick,
  /// it has no layer, and would fall apart.
  std::vector<char> find_backed(const Points& places, const std::vector<double>& depth) const {
    std::vector<char> backed(places.size());
    const double around = second_distance(r_) * 1.01;
    const CellGrid grid(places, around);
    for (std::size_t i = 0; i < places.size(); ++i)
      grid.for_each_near(places[i], [&](std::uint32_t j) {
        if (depth[j] > depth[i] + deeper * r_ && (places[j] - places[i]).norm() < around)
          backed[i] = 1;
      });
    return backed;
  }

  double depth_of(std::size_t i, const Vec3& place) const {
    return planes_[i].height - planes_[i].normal.dot(place);
  }

  SurfaceDistance surface_;
  double r_, offset_;
  std::vector<Plane> planes_;
  std::vector<char> outermost_, deep_;
};

}  // namespace

Irregular conformal_packing(const BodySpace& space, const PackOptions& options,
                            const FilledSites& filled) {
  refuse(space, options, filled);
  const double r = filled.lattice.radius;
  Points places = positions_of(filled.lattice, filled.runs);
  OuterLayer outer(space.surface, places, r, clearance_of(options, r));
  for (int round = 0; round < rounds; ++round) {
    if (round > 0) outer.find(places);
    relax(places, {.distance = nearest_distance(r),
                   .fixed = outer.deep(),
                   .field = [&](std::size_t i, const Vec3& at) { return outer.force(i, at); },
                   .max_steps = steps_of_each});
  }
  Irregular packed;
  const Winding winding = winding_of(space.surface);
  std::size_t i = 0;
  for (const Run& run : filled.runs)
    for (int n = run.first; n < run.last; ++n, ++i) {
      if (winding.around(places[i]).value_or(0) <= 0) continue;
      packed.places.push_back(places[i]);
      packed.body.push_back(run.body);
    }
  return packed;
}

}  // namespace sinew
