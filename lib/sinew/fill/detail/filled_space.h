// SPDX-License-Identifier: GPL-3.0-or-later
// Whether any point, not only a site, is in the part of a body that is filled. In closed surfaces
// the answer is exact; open ones and layers are known by the sites of a finer lattice.
//
//     const FilledSpace space(body, options, radius);
//     if (space.body_at(point) >= 0) keep(point);
#pragma once

#include <optional>

#include <sinew/fill/detail/site_index.h>
#include <sinew/mesh/surface_distance.h>
#include <sinew/mesh/winding.h>

namespace sinew {

class FilledSpace {
 public:
  /// For particles of `radius` (m).
  FilledSpace(const BodySpace& space, const PackOptions& options, double radius);

  /// The body of the mesh around a point (m, the lattice's coordinates); -1: outside.
  std::int32_t body_at(const Vec3& point) const;

 private:
  const Run* run_at(const Vec3& point) const;

  FilledSites fine_;
  SiteIndex index_;
  double clearance_;
  std::optional<Winding> winding_;
  std::optional<SurfaceDistance> distance_;
};

}  // namespace sinew
