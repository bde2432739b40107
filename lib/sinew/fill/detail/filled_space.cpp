// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/fill/detail/filled_space.h>

#include <sinew/core/fcc.h>

namespace sinew {
namespace {

/// The particles' radius over that of the sites: 1 where those only tell which body is around, few
/// where winding numbers of open surfaces take time.
double finer(const BodySpace& space, const PackOptions& options) {
  if (options.thickness) return 4;
  return space.surface.closed() ? 1 : 2;
}

FilledSites fine_sites(const BodySpace& space, PackOptions options, double radius) {
  const double by = finer(space, options);
  options.clearance = clearance_of(options, radius);
  options.keep = Keep::center;
  options.count.reset();
  return fill_sites(space, options, radius / by);
}

}  // namespace

FilledSpace::FilledSpace(const BodySpace& space, const PackOptions& options, double radius)
    : fine_(fine_sites(space, options, radius)),
      index_(fine_.lattice, fine_.runs),
      clearance_(clearance_of(options, radius)) {
  if (!space.surface.closed() || options.thickness) return;
  winding_ = winding_of(space.surface);
  if (clearance_ > 0) distance_.emplace(space.surface);
}

/// With the site nearest to the point, or one next to that.
const Run* FilledSpace::run_at(const Vec3& point) const {
  static const std::vector<FccSite> around = fcc_steps();
  const Lattice& lattice = fine_.lattice;
  const FccSite nearest = nearest_fcc_site((point - lattice.origin).cwiseQuotient(lattice.unit));
  const Run* run = index_.run_at(nearest);
  for (const FccSite& step : around)
    if (run == nullptr && winding_)
      run = index_.run_at({nearest[0] + step[0], nearest[1] + step[1], nearest[2] + step[2]});
  return run;
}

std::int32_t FilledSpace::body_at(const Vec3& point) const {
  if (winding_ && winding_->around(point).value_or(0) <= 0) return -1;
  if (distance_ && distance_->from(point).distance > -clearance_) return -1;
  const Run* run = run_at(point);
  if (run == nullptr) return winding_ ? 0 : -1;
  return run->body;
}

}  // namespace sinew
