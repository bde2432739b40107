// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/fill/fill_report.h>

#include <cmath>

#include <sinew/core/particles.h>

namespace sinew {
namespace {

/// Lengths in a body of that size (m), 0 where they are only rounding.
double without_rounding(double length, double size) {
  constexpr double rounding = 1e-13;  // relative rounding of sums over a million particles
  return std::abs(length) <= rounding * size ? 0 : length;
}

Vec3 without_rounding(const Vec3& place, double size) {
  return place.unaryExpr([=](double x) { return without_rounding(x, size); });
}

std::size_t count_of(std::int64_t n) { return static_cast<std::size_t>(n); }

void add_cleaning(std::vector<ReportRow>& rows, const CleaningCounts& counts) {
  for (const NamedCount& one : cleaning_counts())
    if (one.of == NamedCount::Of::file || counts.*one.count > 0)
      rows.push_back({std::string(one.name), counts.*one.count, std::string(one.unit)});
}

void add_defects(std::vector<ReportRow>& rows, const FillReport& report) {
  const auto add = [&](const char* key, std::size_t count) {
    if (count > 0) rows.push_back({key, count});
  };
  add("holes", report.border.holes);
  add("open_edges", report.border.edges);
  if (report.border.length > 0) rows.push_back({"border_length", report.border.length, "m"});
  add("crowded_edges", report.border.crowded_edges);
  if (report.ambiguous > 0) rows.push_back({"ambiguous_share", report.ambiguous});
  if (report.deepest > 1)
    rows.push_back({"deepest_overlap", count_of(report.deepest), "parts at one place"});
}

/// Only where it adds to the totals.
void add_bodies(std::vector<ReportRow>& rows, const FillReport& report) {
  constexpr std::size_t most = 100;
  if (report.bodies.size() < 2 || report.bodies.size() > most) return;
  std::vector<double> volumes;
  std::vector<std::size_t> counts;
  for (const BodyReport& body : report.bodies) {
    volumes.push_back(body.volume);
    counts.push_back(body.particles);
  }
  rows.push_back({"body_volumes", volumes, "m^3"});
  rows.push_back({"body_particles", counts});
}

void add_verification(std::vector<ReportRow>& rows, const FillReport& report) {
  if (!report.verification) return;
  rows.push_back({"verified_sites", report.verification->sites});
  rows.push_back({"verified_on_surface", report.verification->on_surface});
  rows.push_back({"mismatches", report.verification->mismatches});
}

/// Principal moments of inertia, kg m^2.
Vec3 inertia(const Moments& moments, double mass) {
  return moments.principal() * (moments.volume > 0 ? mass / moments.volume : 0);
}

void add_shape(std::vector<ReportRow>& rows, const FillReport& report) {
  const double mass = report.mass * static_cast<double>(report.particles);
  rows.push_back({"box_size", report.box_size, "m"});
  const double size = report.box_size.maxCoeff();
  const auto add_center = [&](const char* key, const Vec3& center) {
    rows.push_back({key, without_rounding(center, size), "m"});
  };
  add_center("center_of_mass", report.packed.center);
  rows.push_back({"inertia", inertia(report.packed, mass), "kg m^2"});
  if (!report.closed) return;
  add_center("mesh_center_of_mass", report.mesh.center);
  rows.push_back({"mesh_inertia", inertia(report.mesh, mass), "kg m^2"});
  const double offset = (report.packed.center - report.mesh.center).norm();
  rows.push_back({"center_offset", without_rounding(offset, size), "m"});
}

/// The volume of the particles' spheres over that of the body; where some overlap, both count.
double packing_fraction(const FillReport& report) {
  return static_cast<double>(report.particles) * 4 / 3 * pi * std::pow(report.radius, 3) /
         report.volume;
}

}  // namespace

std::vector<ReportRow> rows_of(const FillReport& report) {
  std::vector<ReportRow> rows = {{"particles", report.particles},
                                 {"radius", report.radius, "m"},
                                 {"spacing", nearest_distance(report.radius), "m"}};
  if (report.closed && !report.layer) rows.push_back({"mesh_volume", report.mesh.volume, "m^3"});
  rows.push_back({"packed_volume", report.packed.volume, "m^3"});
  if (report.volume_of_mesh)
    rows.push_back({"volume_ratio", report.packed.volume / report.mesh.volume});
  rows.push_back({"mass_from", std::string(report.volume_of_mesh ? "mesh" : "particles")});
  rows.push_back({"particle_mass", report.mass, "kg"});
  rows.push_back({"total_mass", report.mass * static_cast<double>(report.particles), "kg"});
  add_shape(rows, report);
  rows.push_back({"neighbors", report.neighbors,
                  "particles with 0, 1, .. " + std::to_string(report.neighbors.size() - 1)});
  rows.push_back({"smallest_distance", report.smallest_distance, "diameters"});
  rows.push_back({"mean_distance", report.mean_distance, "diameters"});
  rows.push_back({"packing_fraction", packing_fraction(report)});
  rows.push_back({"modulus_by_direction",
                  std::vector<double>(report.modulus_range.begin(), report.modulus_range.end()),
                  "softest and stiffest, over the mean, of equal springs"});
  rows.push_back({"sites_tested", report.sites});
  rows.push_back({"sites_on_surface", report.ties});
  if (report.kept_out > 0) rows.push_back({"sites_too_close", report.kept_out});
  rows.push_back({"closed", report.closed});
  rows.push_back({"components", count_of(report.components)});
  rows.push_back({"bodies", report.bodies.size()});
  rows.push_back({"cavities", count_of(report.cavities)});
  rows.push_back({"touching_groups", count_of(report.groups)});
  add_bodies(rows, report);
  add_defects(rows, report);
  add_cleaning(rows, report.cleaning);
  add_verification(rows, report);
  return rows;
}

std::vector<ReportRow> times_of(const FillReport& report) {
  std::vector<ReportRow> rows;
  const auto add = [&](const char* key, double seconds) {
    rows.push_back({key, std::round(seconds * 1e6) / 1e6, "s"});
  };
  add("seconds_reading", report.seconds_reading);
  add("seconds_cleaning", report.seconds_cleaning);
  add("seconds_inside", report.seconds_inside);
  add("seconds_particles", report.seconds_particles);
  if (report.verification) add("seconds_verifying", report.seconds_verifying);
  return rows;
}

}  // namespace sinew
