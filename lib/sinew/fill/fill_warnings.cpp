// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/fill/fill_warnings.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <sinew/core/particles.h>
#include <sinew/core/text.h>
#include <sinew/mesh/face_queries.h>

namespace sinew {
namespace {

using Warnings = std::vector<std::string>;

constexpr double much_lost = 0.01;  // fraction of the volume
// Fraction of the requested count: rows of particles enter at once where the radius changes.
constexpr double much_missed = 0.05;
constexpr double coarse = 1e-5;              // radii: strains of bonds are as coarse
constexpr double huge = 100, minute = 1e-3;  // m: outside of these the unit may be wrong

std::string percent(double fraction) { return three_digits(100 * fraction) + " %"; }

/// The body is run near the origin, but its particles are told where it is.
void warn_of_coarse_places(const FillReport& report, const Surface& surface, Warnings& warnings) {
  const Box box = bounds(surface.triangles.points);
  const double farthest = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
  const double apart = farthest * std::numeric_limits<double>::epsilon();
  if (!(apart > coarse * report.radius)) return;
  warnings.push_back("the body is " + three_digits(farthest) +
                     " m from the origin, where numbers tell places to " + three_digits(apart) +
                     " m, " + three_digits(apart / report.radius) +
                     " radii of its particles; move it nearer (body.offset)");
}

void warn_of_holes(const FillReport& report, Warnings& warnings) {
  if (report.closed || report.layer) return;
  warnings.push_back(
      "the surface is open: " + counted(report.border.holes, "hole", "holes") +
      " with a border of " + three_digits(report.border.length) +
      " m; inside is where the winding number is above 0.5, and " + percent(report.ambiguous) +
      " of the points in the box are ambiguous; weld points that almost meet, or close the "
      "holes, if the body bulges in or out there");
}

/// Counts of sites scatter by 0.3 sqrt(sites along the surface) or so: thrice that is significant.
double scatter(double area, double radius) {
  return 0.9 * std::sqrt(area / (4 * radius * radius)) * volume_per_particle(radius);
}

void warn_of_lost_volume(const FillReport& report, const Surface& surface, Warnings& warnings) {
  if (!report.closed || !report.volume_of_mesh) return;
  const double lost = report.volume - report.packed.volume;
  if (lost < std::max(much_lost * report.volume, scatter(area(surface.triangles), report.radius)))
    return;
  const auto thinnest = thinnest_part(surface.triangles);
  const bool thin = thinnest && *thinnest < surely_filled_thickness(report.radius);
  warnings.push_back(
      "particles fill " + percent(report.packed.volume / report.volume) + " of the volume: " +
      (thin ? "parts thinner than particles are lost; a radius of " +
                  three_digits(*thinnest / surely_filled_thickness(1)) + " m keeps them"
            : std::string("their outermost layers lie within the surface; a smaller radius fills "
                          "more")));
}

/// A body thinner than its particles still contains a layer of them.
void warn_of_gained_volume(const FillReport& report, const Surface& surface, Warnings& warnings) {
  if (!report.volume_of_mesh) return;
  const double gained = report.packed.volume - report.volume;
  if (gained < std::max(much_lost * report.volume, scatter(area(surface.triangles), report.radius)))
    return;
  const double times = report.packed.volume / report.volume;
  warnings.push_back("particles take " + three_digits(times) + " times the volume of the mesh: " +
                     (times > 2 ? "it is thinner than they are; give a smaller radius"
                                : "their outermost layers reach the surface; a smaller radius fits "
                                  "better"));
}

std::string why_missed(const FillReport& report) {
  if (report.kept_out > 0)
    return counted(report.kept_out, "site inside is", "sites inside are") +
           " too close to the surface; give a smaller clearance (or keep: center), or a radius";
  if (report.layer)
    return "the layer's volume is not its thickness times the area of the faces; give a radius";
  return "whole layers of the packing enter the body at once; turn the packing "
         "(lattice_rotation), move it (lattice_origin), or give a radius";
}

void warn_of_missed_count(const FillReport& report, Warnings& warnings) {
  if (!report.wanted) return;
  const double wanted = *report.wanted;
  if (std::abs(static_cast<double>(report.particles) - wanted) <= much_missed * wanted) return;
  warnings.push_back(counted(report.particles, "particle", "particles").append(" instead of the ") +
                     std::to_string(*report.wanted) + " requested: " + why_missed(report));
}

void warn_of_overlaps(const FillReport& report, Warnings& warnings) {
  if (!report.verification || report.verification->mismatches == 0 || report.deepest < 2) return;
  warnings.push_back(counted(report.verification->mismatches, "place", "places") +
                     " differ from CGAL, which excludes what two parts of the mesh both cover");
}

void warn_of_lost_bodies(const FillReport& report, Warnings& warnings) {
  const auto empty = std::count_if(report.bodies.begin(), report.bodies.end(),
                                   [](const BodyReport& body) { return body.particles == 0; });
  if (empty > 0)
    warnings.push_back(std::to_string(empty) + " of " +
                       counted(report.bodies.size(), "body", "separate bodies") +
                       " too small for a particle; give a smaller radius");
}

void warn_of_groups(const FillReport& report, Warnings& warnings) {
  if (!report.closed || report.layer) return;
  std::set<int> blocks;
  for (const BodyReport& body : report.bodies)
    if (body.particles > 0) blocks.insert(body.block);
  const auto filled = static_cast<int>(blocks.size());
  if (report.groups < filled)
    warnings.push_back(std::to_string(filled) + " separate bodies touch after filling and make " +
                       std::to_string(report.groups) +
                       ": they will stick together; give a smaller radius, or a clearance");
  if (report.groups > filled)
    warnings.push_back("the particles fall into " + std::to_string(report.groups) +
                       " groups that do not touch, where the mesh has " +
                       counted(filled, "body", "bodies") +
                       ": parts are too thin; give a smaller radius");
}

}  // namespace

std::optional<std::string> cell_warning(double cells, double volume, double radius,
                                        const Surface& surface) {
  constexpr double thinnest_with_cells = 3;  // radii: of walls as thick they hold 99.9 %
  if (cells > (1 - 2 * much_lost) * volume) return std::nullopt;
  const auto thinnest = thinnest_part(surface.triangles);
  const bool thin = thinnest && *thinnest < thinnest_with_cells * radius;
  return "cells (tetrahedra) hold " + percent(cells / volume) + " of the body, " +
         three_digits(cells) + " of " + three_digits(volume) + " m^3: " +
         (thin ? "they are lost in parts thinner than three radii; a radius of " +
                     three_digits(*thinnest / thinnest_with_cells) + " m keeps them"
               : "a smaller radius keeps more");
}

std::optional<std::string> size_warning(double longest) {
  if (longest <= huge && longest >= minute) return std::nullopt;
  return "the body is " + three_digits(longest) +
         " m long: if its lengths are given in another unit, set the unit";
}

std::string counted(std::size_t count, const std::string& what, const std::string& many) {
  return std::to_string(count) + ' ' + (count == 1 ? what : many);
}

Warnings warnings_of(const FillReport& report, const Surface& surface) {
  Warnings warnings;
  if (!surface.warning.empty()) warnings.push_back(surface.warning);
  if (const auto odd = size_warning(report.box_size.maxCoeff())) warnings.push_back(*odd);
  warn_of_coarse_places(report, surface, warnings);
  warn_of_missed_count(report, warnings);
  warn_of_holes(report, warnings);
  warn_of_lost_volume(report, surface, warnings);
  warn_of_gained_volume(report, surface, warnings);
  warn_of_lost_bodies(report, warnings);
  warn_of_groups(report, warnings);
  warn_of_overlaps(report, warnings);
  return warnings;
}

}  // namespace sinew
