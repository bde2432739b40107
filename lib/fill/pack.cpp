// SPDX-License-Identifier: GPL-3.0-or-later
#include "fill/pack.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/available_memory.h"
#include "core/closest_packing.h"
#include "core/error.h"
#include "core/number_text.h"
#include "core/parallel.h"
#include "core/settings_table.h"
#include "core/stopwatch.h"
#include "fill/inside.h"
#include "fill/lattice.h"

namespace sinew {
namespace {

// Bytes while filling: positions, particles, contacts with their cells; a row with its list.
constexpr double bytes_per_particle = 300, bytes_per_row = 100;
constexpr double most_ids = std::numeric_limits<std::int32_t>::max();
constexpr std::size_t rows_at_a_time = 16;
constexpr double enough = 100;  // particles of a radius that is proposed

/// The sites of a row that lie inside, and how many lie on the surface.
struct RowSites {
  std::vector<std::int32_t> inside;
  std::int32_t ties = 0;
};

double rounded(double value, double (*to)(double)) {  // to two digits
  const double unit = std::pow(10, std::floor(std::log10(value)) - 1);
  return to(value / unit) * unit;
}

double wanted_radius(const PackOptions& options, double volume) {
  if (options.radius.has_value() == options.count.has_value())
    throw bad_input(options.radius ? "both a radius and a count are given"
                                   : "neither a radius nor a count is given",
                    "give one of them");
  if (options.count && *options.count < 1)
    throw bad_input("the count is " + std::to_string(*options.count), "give 1 or more");
  const double radius = options.count ? radius_for_count(volume, *options.count) : *options.radius;
  if (!(radius > 0) || !std::isfinite(radius))
    throw bad_input("the radius is " + number_text(radius), "give one above 0");
  if (!(options.density > 0) || !std::isfinite(options.density))
    throw bad_input("the density is " + number_text(options.density), "give one above 0");
  return radius;
}

/// Bytes needed to fill `volume` within `box`.
double bytes_needed(const Box& box, double volume, double radius) {
  return volume / volume_per_particle(radius) * bytes_per_particle +
         lattice_size(box, radius).rows * bytes_per_row;
}

void refuse_too_many(const Box& box, double volume, double radius) {
  const double particles = volume / volume_per_particle(radius), memory = available_memory();
  const double bytes = bytes_needed(box, volume, radius);
  if (particles <= most_ids && bytes <= memory) return;
  double fits = std::max(radius, radius_for_count(volume, most_ids));
  while (bytes_needed(box, volume, fits) > memory) fits *= 1.02;
  throw bad_input(
      "the radius " + three_digits(radius) + " m gives about " + three_digits(particles) +
          " particles, which need " + three_digits(bytes / 1e9) + " GB of memory where " +
          three_digits(memory / 1e9) + " GB are free (the most in any case is 2.15e+09 particles)",
      "a radius of " + three_digits(rounded(fits, std::ceil)) + " m fits");
}

void refuse_too_large(double volume, double radius) {
  if (volume / volume_per_particle(radius) >= 0.5) return;  // 1 less rounding for a count of 1
  throw bad_input("the radius " + three_digits(radius) + " m is too large for a body of " +
                      three_digits(volume) + " m^3: it holds less than one particle",
                  "a radius of " +
                      three_digits(rounded(radius_for_count(volume, enough), std::floor)) +
                      " m fits");
}

std::vector<RowSites> test_rows(const Lattice& lattice, const InsideTest& test) {
  std::vector<RowSites> found(lattice.rows.size());
  parallel_for(lattice.rows.size(), rows_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (int n = 0; n < lattice.rows[i].sites; ++n) {
        const Side side = test.side(lattice.site(lattice.rows[i], n));
        if (side == Side::inside) found[i].inside.push_back(n);
        if (side == Side::boundary) ++found[i].ties;
      }
  });
  return found;
}

/// Inside sites in the order of the rows: the written order, whichever thread found them.
Points gathered(const Lattice& lattice, const std::vector<RowSites>& found) {
  std::size_t count = 0;
  for (const RowSites& row : found) count += row.inside.size();
  if (static_cast<double>(count) > most_ids)
    throw bad_input(std::to_string(count) + " particles are too many for 32-bit ids",
                    "give a larger radius");
  Points points;
  points.reserve(count);
  for (std::size_t i = 0; i < found.size(); ++i)
    for (const std::int32_t n : found[i].inside) points.push_back(lattice.site(lattice.rows[i], n));
  return points;
}

/// A radius, from below `radius`, at which sites do lie inside: their spacing is halved until some
/// do.
[[noreturn]] void refuse_empty(const Surface& surface, const InsideTest& test, Packing packing,
                               double radius) {
  constexpr double most = 1e5;
  const double enclosed = volume(surface.triangles);
  const Box box = bounds(surface.triangles.points);
  double fits = std::min(radius / 2, radius_for_count(enclosed, enough));
  while (enclosed / volume_per_particle(fits) < most) {
    const double tried = rounded(fits, std::floor);
    const Lattice lattice = lattice_in(box, packing, tried);
    if (!gathered(lattice, test_rows(lattice, test)).empty()) {
      fits = tried;
      break;
    }
    fits /= 2;
  }
  throw bad_input("no particle of radius " + three_digits(radius) + " m has its centre inside",
                  "a radius of " + three_digits(rounded(fits, std::floor)) + " m fits");
}

std::vector<std::int32_t> components(const Surface& surface, const InsideTest& test,
                                     const Points& points) {
  std::vector<std::int32_t> component(points.size(), 0);
  if (surface.bodies > 1)  // the first face in any direction bounds the body around the point
    parallel_for(points.size(), 1024, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        component[i] = surface.body[test.face_above(points[i])];
    });
  return component;
}

FillReport basic_report(const Surface& surface, const Particles& particles) {
  FillReport report;
  report.particles = particles.size();
  report.radius = particles.radius;
  report.mass = particles.mass;
  report.mesh_volume = volume(surface.triangles);
  report.packed_volume =
      static_cast<double>(particles.size()) * volume_per_particle(particles.radius);
  report.box_size = bounds(surface.triangles.points).sizes();
  for (std::size_t i = 0; i < particles.size(); ++i) report.centre += particles.position(i);
  report.centre /= static_cast<double>(particles.size());
  report.mesh_centre = centre_of_volume(surface.triangles);
  report.bodies = surface.bodies;
  report.cavities = surface.cavities;
  report.cleaning = surface.cleaning;
  report.seconds_reading = surface.seconds_reading;
  report.seconds_cleaning = surface.seconds_cleaning;
  return report;
}

void add_contacts(Filling& filling) {
  Contacts contacts = contacts_of(filling.particles);
  filling.report.histogram = contacts.histogram;
  filling.report.smallest_distance = contacts.smallest;
  filling.report.mean_distance = contacts.mean;
  filling.neighbours = std::move(contacts.neighbours);
}

}  // namespace

double radius_for_count(double volume, double count) {
  return std::cbrt(volume / count / volume_per_particle(1));
}

Filling pack(const Surface& surface, const PackOptions& options) {
  const double enclosed = volume(surface.triangles);
  const double radius = wanted_radius(options, enclosed);
  const Box box = bounds(surface.triangles.points);
  refuse_too_large(enclosed, radius);
  refuse_too_many(box, enclosed, radius);

  Stopwatch watch;
  const InsideTest test(surface.triangles);
  const double seconds_tree = watch.lap();
  const Lattice lattice = lattice_in(box, options.packing, radius);
  const std::vector<RowSites> found = test_rows(lattice, test);
  const Points points = gathered(lattice, found);
  if (points.empty()) refuse_empty(surface, test, options.packing, radius);

  Filling filling;
  filling.component = components(surface, test, points);
  const double mass = options.density * enclosed / static_cast<double>(points.size());
  filling.particles = particles_at(points, radius, mass);
  const double seconds_inside = watch.lap();

  filling.report = basic_report(surface, filling.particles);
  add_contacts(filling);
  for (const LatticeRow& row : lattice.rows) filling.report.sites += row.sites;
  for (const RowSites& row : found) filling.report.ties += row.ties;
  filling.report.seconds_tree = seconds_tree;
  filling.report.seconds_inside = seconds_inside;
  filling.report.seconds_report = watch.lap();
  return filling;
}

}  // namespace sinew
