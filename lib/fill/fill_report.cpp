// SPDX-License-Identifier: GPL-3.0-or-later
#include "fill/fill_report.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/cell_grid.h"
#include "core/closest_packing.h"
#include "core/parallel.h"
#include "core/settings_table.h"

namespace sinew {
namespace {

constexpr std::size_t grain = 1024;
constexpr double none = std::numeric_limits<double>::infinity();

std::string text(const Vec3& v) {
  return '[' + number_text(v.x()) + ", " + number_text(v.y()) + ", " + number_text(v.z()) + ']';
}

std::string text(const std::array<std::size_t, 13>& counts) {
  std::string list;
  for (const std::size_t count : counts)
    list += (list.empty() ? "[" : ", ") + std::to_string(count);
  return list + ']';
}

void add_cleaning(std::vector<ReportRow>& rows, const CleaningCounts& counts) {
  const auto add = [&](const char* key, std::size_t count) {
    if (count > 0) rows.push_back({key, std::to_string(count), ""});
  };
  add("polygons_cut", counts.polygons_cut);
  add("points_merged", counts.points_merged);
  add("points_unused", counts.points_unused);
  add("faces_collapsed", counts.faces_collapsed);
  add("faces_doubled", counts.faces_doubled);
  add("faces_flat", counts.faces_flat);
  add("faces_turned", counts.faces_turned);
}

void add_seconds(std::vector<ReportRow>& rows, const FillReport& report) {
  const auto add = [&](const char* key, double seconds) {
    rows.push_back({key, number_text(std::round(seconds * 1e6) / 1e6), "s"});
  };
  add("seconds_reading", report.seconds_reading);
  add("seconds_cleaning", report.seconds_cleaning);
  add("seconds_tree", report.seconds_tree);
  add("seconds_inside", report.seconds_inside);
  add("seconds_report", report.seconds_report);
}

}  // namespace

Contacts contacts_of(const Particles& particles) {
  const double range = rest_neighbour_range(particles.radius);
  const CellGrid grid(particles.x, particles.y, particles.z, range);
  Contacts contacts;
  contacts.neighbours.resize(particles.size());
  std::vector<double> nearest(particles.size(), none);
  parallel_for(particles.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      grid.for_each_near(particles.position(i), [&](std::uint32_t j) {
        const double distance = (particles.position(j) - particles.position(i)).norm();
        if (j == i || distance >= range) return;
        ++contacts.neighbours[i];
        nearest[i] = std::min(nearest[i], distance);
      });
  });
  const double full = nearest_distance(particles.radius);
  std::size_t touching = 0;
  double smallest = none, sum = 0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    ++contacts.histogram[std::min(contacts.neighbours[i], 12)];
    if (nearest[i] == none) continue;
    smallest = std::min(smallest, nearest[i]);
    sum += nearest[i] / full;
    ++touching;
  }
  if (touching > 0) contacts.smallest = smallest / full;
  if (touching > 0) contacts.mean = sum / static_cast<double>(touching);
  return contacts;
}

Vec3 centre_of_volume(const Triangles& surface) {
  const Vec3 middle = bounds(surface.points).center();  // keeps digits far from the origin
  Vec3 moment = Vec3::Zero();
  double sum = 0;
  for (const auto& [i, j, k] : surface.faces) {
    const Vec3 a = surface.points[i] - middle, b = surface.points[j] - middle,
               c = surface.points[k] - middle;
    const double part = a.dot(b.cross(c));  // six times the volume of a tetrahedron
    sum += part;
    moment += part * (a + b + c) / 4;
  }
  return middle + moment / sum;
}

std::vector<ReportRow> rows_of(const FillReport& report) {
  const auto count = [](std::size_t n) { return std::to_string(n); };
  std::vector<ReportRow> rows = {
      {"particles", count(report.particles), ""},
      {"radius", number_text(report.radius), "m"},
      {"spacing", number_text(nearest_distance(report.radius)), "m"},
      {"mesh_volume", number_text(report.mesh_volume), "m^3"},
      {"packed_volume", number_text(report.packed_volume), "m^3"},
      {"volume_ratio", number_text(report.packed_volume / report.mesh_volume), ""},
      {"particle_mass", number_text(report.mass), "kg"},
      {"total_mass", number_text(report.mass * static_cast<double>(report.particles)), "kg"},
      {"box_size", text(report.box_size), "m"},
      {"centre_of_mass", text(report.centre), "m"},
      {"mesh_centre_of_mass", text(report.mesh_centre), "m"},
      {"centre_offset", number_text((report.centre - report.mesh_centre).norm()), "m"},
      {"neighbours", text(report.histogram), "particles with 0, 1, .. 12"},
      {"smallest_distance", number_text(report.smallest_distance), "2r"},
      {"mean_distance", number_text(report.mean_distance), "2r"},
      {"sites_tested", count(report.sites), ""},
      {"sites_on_surface", count(report.ties), ""},
      {"bodies", std::to_string(report.bodies), ""},
      {"cavities", std::to_string(report.cavities), ""},
      {"points_read", count(report.cleaning.points_read), ""},
      {"faces_read", count(report.cleaning.polygons_read), ""}};
  add_cleaning(rows, report.cleaning);
  add_seconds(rows, report);
  return rows;
}

}  // namespace sinew
