// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/fill/pack.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/error.h>
#include <sinew/core/particles.h>
#include <sinew/core/system.h>
#include <sinew/core/text.h>
#include <sinew/fill/detail/irregular.h>
#include <sinew/fill/detail/isotropy.h>
#include <sinew/fill/detail/owners.h>
#include <sinew/fill/detail/verify.h>
#include <sinew/fill/detail/volume_shares.h>
#include <sinew/fill/fill_limits.h>
#include <sinew/fill/fill_warnings.h>
#include <sinew/fill/filled_sites.h>
#include <sinew/mesh/clean.h>

namespace sinew {
namespace {

void check(const Surface& surface, const PackOptions& options) {
  if (options.radius.has_value() == options.count.has_value())
    throw bad_input(options.radius ? "both a radius and a count are given"
                                   : "neither a radius nor a count is given",
                    "give one of them");
  const auto positive = [](const char* name, double value) {
    if (!(value > 0) || !std::isfinite(value))
      throw bad_input(std::string("the ").append(name) + " is " + number_text(value),
                      "give one above 0");
  };
  if (options.radius) positive("radius", *options.radius);
  if (options.count) positive("count", *options.count);
  if (options.thickness) positive("thickness", *options.thickness);
  positive("density", options.density);
  if (options.verify && !is_lattice(options.packing))
    throw bad_input("only sites of a lattice can be verified, not places of other packings",
                    "leave the verification out, or set packing to fcc");
  if (options.verify && !options.thickness) refuse_unverifiable(surface);
  if (!options.thickness) return;
  if (options.keep != Keep::center || options.clearance > 0)
    throw bad_input("a layer along the surface has no clearance from it",
                    "give either a thickness, or keep and clearance");
  if (options.verify)
    throw bad_input("only what is inside can be verified, not a layer along the surface",
                    "leave the thickness or the verification out");
}

/// Particles at the sites of the runs, in their order.
Particles particles_in(const FilledSites& filled, const LatticeFrame& placement) {
  Particles particles = particles_at_rest(count_of(filled.runs));
  particles.radius = filled.lattice.radius;
  for_each_site(filled.runs, [&](std::size_t place, const Run& run, int n) {
    particles.set_position(place, placement.from_lattice(filled.lattice.site(run.row, n)));
  });
  return particles;
}

/// The body of each particle: the mesh's where it is closed, else the connected component.
std::vector<std::int32_t> components_of(const FilledSites& filled, const Touching& touching) {
  std::vector<std::int32_t> component;
  component.reserve(touching.neighbors.size());
  for (std::size_t i = 0; i < filled.runs.size(); ++i)
    component.insert(component.end(), filled.runs[i].sites(),
                     filled.inside.bodies > 0 ? filled.runs[i].body : touching.group[i]);
  return component;
}

void report_surface(const Surface& surface, FillReport& report) {
  report.box_size = bounds(surface.triangles.points).sizes();
  report.mesh = moments_of(surface.triangles);
  report.closed = surface.closed();
  report.border = surface.border;
  report.components = surface.components;
  report.cleaning = surface.cleaning;
  report.seconds_reading = surface.seconds_reading;
  report.seconds_cleaning = surface.seconds_cleaning;
}

void report_sites(const FilledSites& filled, const BodySpace& space, FillReport& report) {
  report.radius = filled.lattice.radius;
  report.sites = filled.lattice.sites();
  report.ties = filled.inside.on_surface.size();
  report.kept_out =
      count_of(filled.inside.runs) > 0 ? count_of(filled.inside.runs) - count_of(filled.runs) : 0;
  report.deepest = filled.inside.deepest;
  report.shallowest = filled.inside.shallowest;
  report.layer = filled.inside.runs.empty();
  report.bodies.resize(filled.inside.bodies);
  for (int body = 0; body < filled.inside.bodies; ++body)
    report.bodies[body].block = filled.inside.block_of[body];
  const std::vector<double> volumes = component_volumes(space.surface);
  for (std::size_t i = 0; i < filled.inside.body_of.size(); ++i) {
    const int body = filled.inside.body_of[i];
    if (body >= 0) report.bodies[body].volume += volumes[i];
    report.cavities += volumes[i] < 0;
  }
}

void report_particles(const Filling& filling, FillReport& report) {
  report.particles = filling.particles.size();
  for (const std::int32_t count : filling.neighbors) {
    const auto touching = static_cast<std::size_t>(count);
    if (touching >= report.neighbors.size()) report.neighbors.resize(touching + 1);
    ++report.neighbors[touching];
  }
  if (!report.bodies.empty())
    for (const std::int32_t body : filling.component) ++report.bodies[body].particles;
}

/// Distances and directions of nearest neighbors on a lattice.
void report_lattice(const Lattice& lattice, FillReport& report) {
  double least = HUGE_VAL, sum = 0;
  DirectionalStiffness springs;
  for (const int layer : {0, 1})  // layers of HCP take turns
    for (const LatticePlace& step : lattice.nearest(layer)) {
      const Vec3 bond = lattice.unit.cwiseProduct(Vec3(step[0], step[1], step[2]));
      least = std::min(least, bond.norm());
      sum += bond.norm();
      springs.add(bond);
    }
  report.smallest_distance = least / nearest_distance(lattice.radius);
  report.mean_distance = sum / 24 / nearest_distance(lattice.radius);
  report.modulus_range = springs.modulus_range();
}

/// The mass is that of the mesh's volume where the particles fill just that, else of their own.
void report_mass(Particles& particles, const PackOptions& options, FillReport& report) {
  report.packed = moments_of(particles, volume_per_particle(report.radius));
  report.volume_of_mesh = report.closed && report.deepest <= 1 && report.shallowest >= 0 &&
                          !options.thickness && report.kept_out == 0;
  report.volume = report.volume_of_mesh ? report.mesh.volume : report.packed.volume;
  report.mass = options.density * report.volume / static_cast<double>(particles.size());
  particles.mass = report.mass;
}

/// What particles are placed by.
struct Task {
  const Surface& surface;
  const PackOptions& options;
  const BodySpace& space;
  const FilledSites& filled;

  std::vector<double> volume_shares(const Owners& owners, const FillReport& report) const {
    return sinew::volume_shares(surface, options, space, filled.lattice, owners,
                                report.volume_of_mesh ? report.volume : 0);
  }
};

void place_on_sites(const Task& task, Filling& filling) {
  FillReport& report = filling.report;
  Touching touching = touching_sites(task.filled.lattice, task.filled.runs);
  filling.particles = particles_in(task.filled, task.space.placement);
  filling.component = components_of(task.filled, touching);
  report.groups = touching.groups;
  if (std::any_of(touching.neighbors.begin(), touching.neighbors.end(),
                  [](std::int32_t count) { return count > 0; }))
    report_lattice(task.filled.lattice, report);
  report_mass(filling.particles, task.options, report);
  if (task.options.volume_shares && task.options.packing == Packing::fcc)
    filling.volume_share = task.volume_shares(SiteOwners(task.filled, touching), report);
  filling.neighbors = std::move(touching.neighbors);
}

void place_irregularly(const Task& task, Filling& filling) {
  FillReport& report = filling.report;
  Irregular packed = irregular_packing(task.space, task.options, task.filled);
  const double radius = task.filled.lattice.radius;
  filling.particles = particles_at_rest(packed.places.size());
  filling.particles.radius = radius;
  for (std::size_t i = 0; i < packed.places.size(); ++i) {
    filling.particles.set_position(i, task.space.placement.from_lattice(packed.places[i]));
    filling.neighbors.push_back(static_cast<std::int32_t>(packed.touching.of(i).size()));
  }
  report.groups = packed.groups;
  report.smallest_distance = packed.smallest / nearest_distance(radius);
  report.mean_distance = packed.mean / nearest_distance(radius);
  report.modulus_range = packed.springs.modulus_range();
  report_mass(filling.particles, task.options, report);
  if (task.options.volume_shares) {
    const Lattice& lattice = task.filled.lattice;
    Points places = packed.places;
    for (Vec3& place : places) place = (place - lattice.origin).cwiseQuotient(lattice.unit);
    filling.volume_share =
        task.volume_shares(PointOwners(std::move(places), packed.touching), report);
  }
  filling.component =
      task.filled.inside.bodies > 0 ? std::move(packed.body) : std::move(packed.group);
}

}  // namespace

Filling pack(const Surface& surface, const PackOptions& options) {
  check(surface, options);
  Stopwatch watch;
  const BodySpace space(surface, options);
  Filling filling;
  FillReport& report = filling.report;
  report.wanted = options.count;
  report.ambiguous = refuse_without_inside(space, options);
  const double wanted = wanted_radius(space, options);
  const FilledSites filled = fill_sites(space, options, wanted);
  if (filled.runs.empty()) refuse_empty(space, options, filled);
  refuse_found(filled, options);
  report.seconds_inside = watch.lap();

  report_surface(surface, report);
  report_sites(filled, space, report);
  const Task task = {surface, options, space, filled};
  is_lattice(options.packing) ? place_on_sites(task, filling) : place_irregularly(task, filling);
  report_particles(filling, report);
  report.seconds_particles = watch.lap();

  if (options.verify) report.verification = verify(filled.lattice, space.surface, filled.inside);
  report.seconds_verifying = watch.lap();
  report.warnings = warnings_of(report, surface);
  return filling;
}

Filling fill(Points points, std::vector<std::vector<int>> polygons, const PackOptions& options) {
  const PolygonSoup soup{std::move(points), std::move(polygons)};
  check_soup(soup);
  return pack(clean(soup), options);
}

}  // namespace sinew
