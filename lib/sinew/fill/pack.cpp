// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/fill/pack.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/error.h>
#include <sinew/core/particles.h>
#include <sinew/core/system.h>
#include <sinew/core/text.h>
#include <sinew/fill/fill_limits.h>
#include <sinew/fill/fill_warnings.h>
#include <sinew/fill/filled_sites.h>
#include <sinew/fill/shares.h>
#include <sinew/fill/verify.h>

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
  report.particles = count_of(filled.runs);
  report.ties = filled.inside.on_surface.size();
  report.kept_out =
      count_of(filled.inside.runs) > 0 ? count_of(filled.inside.runs) - report.particles : 0;
  report.deepest = filled.inside.deepest;
  report.shallowest = filled.inside.shallowest;
  report.layer = filled.inside.runs.empty();
  report.bodies.resize(filled.inside.bodies);
  const std::vector<double> volumes = component_volumes(space.surface);
  for (std::size_t i = 0; i < filled.inside.body_of.size(); ++i) {
    const int body = filled.inside.body_of[i];
    if (body >= 0) report.bodies[body].volume += volumes[i];
    report.cavities += volumes[i] < 0;
  }
  for (const Run& run : filled.runs)
    if (!report.bodies.empty()) report.bodies[run.body].particles += run.sites();
}

void report_neighbors(const Touching& touching, const Lattice& lattice, FillReport& report) {
  for (const std::int32_t count : touching.neighbors) ++report.neighbors[count];
  report.groups = touching.groups;
  if (report.neighbors[0] == report.particles) return;
  double least = HUGE_VAL, sum = 0;
  for (const LatticePlace& step : lattice.nearest(0)) {
    const double length = lattice.unit.cwiseProduct(Vec3(step[0], step[1], step[2])).norm();
    least = std::min(least, length);
    sum += length;
  }
  report.smallest_distance = least / nearest_distance(lattice.radius);
  report.mean_distance = sum / 12 / nearest_distance(lattice.radius);
}

/// The mass is that of the mesh's volume where the particles fill just that, else of their own.
void report_mass(Particles& particles, const PackOptions& options, FillReport& report) {
  report.packed = moments_of(particles, volume_per_particle(report.radius));
  report.volume_of_mesh = report.closed && report.deepest <= 1 && report.shallowest >= 0 &&
                          !options.thickness && report.kept_out == 0;
  report.volume = report.volume_of_mesh ? report.mesh.volume : report.packed.volume;
  report.mass = options.density * report.volume / static_cast<double>(report.particles);
  particles.mass = report.mass;
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
  refuse_found(filled);
  report.seconds_inside = watch.lap();

  Touching touching = touching_sites(filled.lattice, filled.runs);
  filling.particles = particles_in(filled, space.placement);
  filling.component = components_of(filled, touching);
  report_surface(surface, report);
  report_sites(filled, space, report);
  report_neighbors(touching, filled.lattice, report);
  report_mass(filling.particles, options, report);
  if (options.shares && options.packing == Packing::fcc)
    filling.share = volume_shares(surface, options, space, filled, touching,
                                  report.volume_of_mesh ? report.volume : 0);
  filling.neighbors = std::move(touching.neighbors);
  report.seconds_particles = watch.lap();

  if (options.verify) report.verification = verify(filled.lattice, space.surface, filled.inside);
  report.seconds_verifying = watch.lap();
  report.warnings = warnings_of(report, surface);
  return filling;
}

}  // namespace sinew
