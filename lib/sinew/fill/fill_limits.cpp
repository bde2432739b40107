// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/fill/fill_limits.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <sinew/core/error.h>
#include <sinew/core/particles.h>
#include <sinew/core/system.h>
#include <sinew/core/text.h>
#include <sinew/fill/filled_sites.h>

namespace sinew {

double radius_for_count(double volume, double count) {
  return std::cbrt(volume / count / volume_per_particle(1));
}

Inside volume_inside(const Surface& surface) {
  const double enclosed = surface.closed() ? volume(surface.triangles) : 0;
  if (surface.closed() && surface.components == 1) return {enclosed, true};
  const Lattice lattice = coarse_lattice(bounds(surface.triangles.points));
  const InsideRuns inside = inside_runs(lattice, surface);
  if (surface.closed() && inside.deepest <= 1 && inside.shallowest >= 0) return {enclosed, true};
  return {static_cast<double>(count_of(inside.runs)) * volume_per_particle(lattice.radius), false};
}

double ambiguous_fraction(const Surface& surface) {
  if (surface.closed()) return 0;
  return ambiguous_fraction(coarse_lattice(bounds(surface.triangles.points)), surface);
}

namespace {

// A volume this small relative to area times size is the rounding error of a flat body.
constexpr double rounding_of_volume = 1e-13;
// Bytes while filling and writing: positions, velocities, counts and their copies for output.
// Packings without a lattice hold lists of neighbors, too, and particles around the body.
constexpr double bytes_on_sites = 150, bytes_elsewhere = 600, bytes_per_row = 100;

double bytes_per_particle(const PackOptions& options) {
  return is_lattice(options.packing) ? bytes_on_sites : bytes_elsewhere;
}

// Particles have ids of 32 bits.
constexpr double max_ids = std::numeric_limits<std::int32_t>::max();
// In lengths of the body: doubles place a site there to 1e-12 of that length.
constexpr double farthest_origin = 1e4;
constexpr double enough = 100;  // particles at a proposed radius
constexpr double finest = 400;  // radii along the box, in the search for a radius that fits

const char* const thicken = "give a thickness to fill a layer along the surface";

double rounded(double value, double (*to)(double)) {  // to two digits
  const double unit = std::pow(10, std::floor(std::log10(value)) - 1);
  return to(value / unit) * unit;
}

double rounded_down(double radius) { return rounded(radius, std::floor); }

/// Bytes needed to fill `volume` in `box`.
double bytes_needed(const Box& box, const PackOptions& options, double volume, double radius) {
  return volume / volume_per_particle(radius) * bytes_per_particle(options) +
         lattice_size(box, radius).rows * bytes_per_row;
}

std::string gigabytes(double bytes) { return three_digits(bytes / 1e9) + " GB"; }

void refuse_without_volume(const Triangles& surface) {
  const double enclosed = volume(surface), skin = area(surface);
  const double size = bounds(surface.points).diagonal().norm();
  if (!std::isfinite(enclosed) || !std::isfinite(skin * size))
    throw bad_input("the surface is too large for its volume to be computed",
                    "scale it down, or set its unit");
  if (enclosed > rounding_of_volume * skin * size) return;
  throw bad_input("the surface encloses a volume of " + number_text(enclosed) +
                      " m^3 with an area of " + number_text(skin) + " m^2",
                  std::string("give a solid body, or ") + (thicken + 5));
}

void refuse_too_many(const Box& box, const PackOptions& options, double volume, double radius) {
  const double particles = volume / volume_per_particle(radius), memory = available_memory();
  const double bytes = bytes_needed(box, options, volume, radius);
  if (particles <= max_ids && bytes <= memory) return;
  double fits = std::max(radius, radius_for_count(volume, max_ids));
  for (int round = 0; bytes_needed(box, options, volume, fits) > memory && round < 5000; ++round)
    fits *= 1.02;
  throw bad_input("the radius " + three_digits(radius) + " m gives about " +
                      three_digits(particles) + " particles, which need " + gigabytes(bytes) +
                      " of memory where " + gigabytes(memory) +
                      " are free (the most in any case is 2.15e+09 particles)",
                  "a radius of " + three_digits(rounded(fits, std::ceil)) + " m fits");
}

void refuse_too_large(double volume, double radius) {
  if (volume / volume_per_particle(radius) >= 0.5) return;  // 1 minus rounding for a count of 1
  throw bad_input(
      "the radius " + three_digits(radius) + " m is too large for a body of " +
          three_digits(volume) + " m^3: it holds less than one particle",
      "a radius of " + three_digits(rounded_down(radius_for_count(volume, enough))) + " m fits");
}

/// A radius below `radius` at which sites lie inside, by halving it; 0 where none is found.
double radius_that_fits(const BodySpace& space, const PackOptions& options, double radius) {
  const double longest = space.box.sizes().maxCoeff();
  PackOptions tried = options;
  tried.count.reset();
  const double about = volume_inside(space.surface).volume;
  double fits = std::min(radius / 2, about > 0 ? radius_for_count(about, enough) : longest / 4);
  for (; longest / fits < finest; fits /= 2)
    if (!fill_sites(space, tried, rounded_down(fits)).runs.empty()) return rounded_down(fits);
  return 0;
}

/// Refuses a layer much thicker than the body, and a lattice too far away for its sites' precision.
void refuse_out_of_place(const BodySpace& space, const PackOptions& options) {
  const Box box = bounds(space.surface.triangles.points);
  const double longest = box.sizes().maxCoeff();
  if (options.thickness && *options.thickness > 2 * longest)
    throw bad_input("a layer of " + three_digits(*options.thickness) +
                        " m is thicker than twice the body, which is " + three_digits(longest) +
                        " m long",
                    "give a smaller thickness");
  if (!space.lattice_origin) return;
  const double away = (*space.lattice_origin - box.center()).norm();
  if (!(away <= farthest_origin * longest))
    throw bad_input("the lattice's origin lies " + three_digits(away) + " m from a body of " +
                        three_digits(longest) + " m",
                    "give an origin near the body");
}

/// Estimate of the volume that will be filled, m^3.
double volume_to_fill(const BodySpace& space, const PackOptions& options) {
  if (options.thickness) return area(space.surface.triangles) * *options.thickness;
  return volume_inside(space.surface).volume;
}

}  // namespace

double refuse_without_inside(const BodySpace& space, const PackOptions& options) {
  if (options.thickness) return 0;
  if (space.surface.closed()) {
    refuse_without_volume(space.surface.triangles);
    return 0;
  }
  const double fraction = ambiguous_fraction(space.surface);
  if (fraction > max_ambiguous)
    throw bad_input("the surface has no inside: " + three_digits(100 * fraction) +
                        " % of the points in its box lie neither clearly inside nor outside (the "
                        "most is " +
                        three_digits(100 * max_ambiguous) + " %)",
                    "close its holes, or give a thickness to fill a layer along it");
  return fraction;
}

double wanted_radius(const BodySpace& space, const PackOptions& options) {
  refuse_out_of_place(space, options);
  const double about = volume_to_fill(space, options);
  const double radius = options.radius ? *options.radius : radius_for_count(about, *options.count);
  if (!(radius > 0))
    throw bad_input("no volume was found inside the surface, so that a count gives no radius",
                    "give a thickness, or a radius");
  if (space.surface.closed() && !options.thickness) refuse_too_large(about, radius);
  refuse_too_many(space.box, options, about, radius);
  return radius;
}

void refuse_empty(const BodySpace& space, const PackOptions& options, const FilledSites& filled) {
  const double radius = filled.lattice.radius;
  if (const std::size_t inside = count_of(filled.inside.runs); inside > 0)
    throw bad_input("all " + std::to_string(inside) + " lattice sites inside lie within " +
                        three_digits(clearance_of(options, radius)) + " m of the surface",
                    "give a smaller clearance or radius");
  const double fits = radius_that_fits(space, options, radius);
  throw bad_input(
      "no particle of radius " + three_digits(radius) + " m has its center inside",
      fits > 0 ? "a radius of " + three_digits(fits) + " m fits" : std::string(thicken));
}

void refuse_found(const FilledSites& filled, const PackOptions& options) {
  const auto count = static_cast<double>(count_of(filled.runs));
  const double memory = available_memory(), bytes = count * bytes_per_particle(options);
  if (count <= max_ids && bytes <= memory) return;
  throw bad_input("the radius " + three_digits(filled.lattice.radius) + " m gives " +
                      three_digits(count) + " particles, which need " + gigabytes(bytes) +
                      " of memory where " + gigabytes(memory) + " are free",
                  "give a larger radius");
}

}  // namespace sinew
