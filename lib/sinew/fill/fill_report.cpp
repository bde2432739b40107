// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/fill/fill_report.h>

#include <cmath>

#include <sinew/core/particles.h>
#include <sinew/core/text.h>

namespace sinew {
namespace {

/// JSON has no word for numbers that are not finite.
std::string json_number(double value) { return std::isfinite(value) ? number_text(value) : "null"; }

std::string text(const Vec3& v) {
  return '[' + json_number(v.x()) + ", " + json_number(v.y()) + ", " + json_number(v.z()) + ']';
}

/// Lengths in a body of that size (m), 0 where they are but rounding.
double without_rounding(double length, double size) {
  constexpr double rounding = 1e-13;  // of sums over a million particles
  return std::abs(length) <= rounding * size ? 0 : length;
}

Vec3 without_rounding(const Vec3& place, double size) {
  return place.unaryExpr([=](double x) { return without_rounding(x, size); });
}

std::string text(const std::array<std::size_t, 13>& counts) {
  std::string list;
  for (const std::size_t count : counts)
    list += (list.empty() ? "[" : ", ") + std::to_string(count);
  return list + ']';
}

void add_cleaning(std::vector<ReportRow>& rows, const CleaningCounts& counts) {
  for (const NamedCount& one : cleaning_counts())
    if (one.of == NamedCount::Of::file || counts.*one.count > 0)
      rows.push_back({std::string(one.name), std::to_string(counts.*one.count), ""});
}

void add_defects(std::vector<ReportRow>& rows, const FillReport& report) {
  const auto add = [&](const char* key, std::size_t count) {
    if (count > 0) rows.push_back({key, std::to_string(count), ""});
  };
  add("holes", report.border.holes);
  add("open_edges", report.border.edges);
  if (report.border.length > 0)
    rows.push_back({"border_length", json_number(report.border.length), "m"});
  add("crowded_edges", report.border.crowded_edges);
  if (report.ambiguous > 0) rows.push_back({"ambiguous_share", json_number(report.ambiguous), ""});
  if (report.deepest > 1)
    rows.push_back({"deepest_overlap", std::to_string(report.deepest), "parts at one place"});
}

/// Only where it tells more than the totals.
void add_bodies(std::vector<ReportRow>& rows, const FillReport& report) {
  constexpr std::size_t most = 100;
  if (report.bodies.size() < 2 || report.bodies.size() > most) return;
  std::string volumes, counts;
  for (const BodyReport& body : report.bodies) {
    volumes.append(volumes.empty() ? "[" : ", ").append(json_number(body.volume));
    counts.append(counts.empty() ? "[" : ", ").append(std::to_string(body.particles));
  }
  rows.push_back({"body_volumes", volumes + ']', "m^3"});
  rows.push_back({"body_particles", counts + ']', ""});
}

void add_verification(std::vector<ReportRow>& rows, const FillReport& report) {
  if (!report.verification) return;
  rows.push_back({"verified_sites", std::to_string(report.verification->sites), ""});
  rows.push_back({"verified_on_surface", std::to_string(report.verification->on_surface), ""});
  rows.push_back({"mismatches", std::to_string(report.verification->mismatches), ""});
}

void add_seconds(std::vector<ReportRow>& rows, const FillReport& report) {
  const auto add = [&](const char* key, double seconds) {
    rows.push_back({key, json_number(std::round(seconds * 1e6) / 1e6), "s"});
  };
  add("seconds_reading", report.seconds_reading);
  add("seconds_cleaning", report.seconds_cleaning);
  add("seconds_inside", report.seconds_inside);
  add("seconds_particles", report.seconds_particles);
  if (report.verification) add("seconds_verifying", report.seconds_verifying);
}

/// Principal moments of inertia, kg m^2.
std::string inertia(const Moments& moments, double mass) {
  return text(Vec3(moments.principal() * (moments.volume > 0 ? mass / moments.volume : 0)));
}

void add_shape(std::vector<ReportRow>& rows, const FillReport& report) {
  const double mass = report.mass * static_cast<double>(report.particles);
  rows.push_back({"box_size", text(report.box_size), "m"});
  const double size = report.box_size.maxCoeff();
  const auto add_center = [&](const char* key, const Vec3& center) {
    rows.push_back({key, text(without_rounding(center, size)), "m"});
  };
  add_center("center_of_mass", report.packed.center);
  rows.push_back({"inertia", inertia(report.packed, mass), "kg m^2"});
  if (!report.closed) return;
  add_center("mesh_center_of_mass", report.mesh.center);
  rows.push_back({"mesh_inertia", inertia(report.mesh, mass), "kg m^2"});
  const double offset = (report.packed.center - report.mesh.center).norm();
  rows.push_back({"center_offset", json_number(without_rounding(offset, size)), "m"});
}

}  // namespace

std::vector<ReportRow> rows_of(const FillReport& report) {
  const auto count = [](std::size_t n) { return std::to_string(n); };
  std::vector<ReportRow> rows = {{"particles", count(report.particles), ""},
                                 {"radius", json_number(report.radius), "m"},
                                 {"spacing", json_number(nearest_distance(report.radius)), "m"}};
  if (report.closed && !report.layer)
    rows.push_back({"mesh_volume", json_number(report.mesh.volume), "m^3"});
  rows.push_back({"packed_volume", json_number(report.packed.volume), "m^3"});
  if (report.volume_of_mesh)
    rows.push_back({"volume_ratio", json_number(report.packed.volume / report.mesh.volume), ""});
  rows.push_back({"mass_from", report.volume_of_mesh ? "\"mesh\"" : "\"particles\"", ""});
  rows.push_back({"particle_mass", json_number(report.mass), "kg"});
  rows.push_back(
      {"total_mass", json_number(report.mass * static_cast<double>(report.particles)), "kg"});
  add_shape(rows, report);
  rows.push_back({"neighbors", text(report.neighbors), "particles with 0, 1, .. 12"});
  rows.push_back({"smallest_distance", json_number(report.smallest_distance), "diameters"});
  rows.push_back({"mean_distance", json_number(report.mean_distance), "diameters"});
  rows.push_back({"sites_tested", count(report.sites), ""});
  rows.push_back({"sites_on_surface", count(report.ties), ""});
  if (report.kept_out > 0) rows.push_back({"sites_too_close", count(report.kept_out), ""});
  rows.push_back({"closed", report.closed ? "true" : "false", ""});
  rows.push_back({"components", count(report.components), ""});
  rows.push_back({"bodies", count(report.bodies.size()), ""});
  rows.push_back({"cavities", count(report.cavities), ""});
  rows.push_back({"touching_groups", count(report.groups), ""});
  add_bodies(rows, report);
  add_defects(rows, report);
  add_cleaning(rows, report.cleaning);
  add_verification(rows, report);
  add_seconds(rows, report);
  return rows;
}

}  // namespace sinew
