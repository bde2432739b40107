// SPDX-License-Identifier: GPL-3.0-or-later
// The report of a filling: counts, sizes, volumes and times.
//
//     for (const ReportRow& row : rows_of(filling.report)) results.push_back(row);
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <sinew/fill/moments.h>
#include <sinew/mesh/surface.h>

namespace sinew {

/// One body of the mesh.
struct BodyReport {
  double volume = 0;  ///< enclosed by its surface, m^3; 0 where the surface is open
  std::size_t particles = 0;
  int block = 0;  ///< the first of the bodies that it shares faces with
};

/// Every site of the lattice checked against CGAL.
struct Verification {
  std::size_t sites = 0;
  std::size_t on_surface = 0;  ///< sites on the surface according to CGAL
  std::size_t mismatches = 0;  ///< sites inside by one of the two and not by the other
};

struct FillReport {
  std::size_t particles = 0;
  std::optional<int> wanted;  ///< particles, where a count was requested
  std::uint64_t sites = 0;    ///< sites of the lattice in the mesh's box
  std::size_t ties = 0;       ///< sites on the surface: outside
  std::size_t kept_out = 0;   ///< sites inside but too close to the surface
  double radius = 0;          ///< m
  double mass = 0;            ///< mass of one particle, kg
  double volume = 0;          ///< volume of that mass, m^3: the mesh's, else the particles'
  bool volume_of_mesh = true;
  Moments mesh, packed;
  Vec3 box_size = Vec3::Zero();                                       ///< size of the mesh's box, m
  std::vector<std::size_t> neighbors = std::vector<std::size_t>(13);  ///< particles with 0, 1, ..
  double smallest_distance = 0, mean_distance = 0;  ///< nearest neighbors, over 2r; 0: none touch
  /// Young's modulus of equal springs between touching particles, along the softest and stiffest
  /// direction over the mean; 0: none.
  std::array<double, 2> modulus_range = {};
  std::vector<BodyReport> bodies;
  int cavities = 0;
  int groups = 0;  ///< groups of particles connected by touching
  int shallowest = 0;
  int deepest = 0;  ///< winding number; above 1 where parts of the mesh overlap
  bool closed = true;
  bool layer = false;    ///< along the surface, of a given thickness, instead of its inside
  double ambiguous = 0;  ///< fraction of points whose winding number is far from an integer
  Border border;
  int components = 0;
  CleaningCounts cleaning;
  std::optional<Verification> verification;
  std::vector<std::string> warnings;  ///< each with its cure
  double seconds_reading = 0, seconds_cleaning = 0, seconds_inside = 0, seconds_particles = 0,
         seconds_verifying = 0;
};

using ReportValue = std::variant<std::size_t, double, bool, std::string, Vec3,
                                 std::vector<std::size_t>, std::vector<double>>;

/// A row of the report.
struct ReportRow {
  std::string key;
  ReportValue value;
  std::string unit = {};
};

/// The report for people and scripts, `particles` first. Counts of defects only where not 0.
std::vector<ReportRow> rows_of(const FillReport& report);
/// How long its parts took, which no file of a body keeps: the same filling gives the same bytes.
std::vector<ReportRow> times_of(const FillReport& report);

}  // namespace sinew
