// SPDX-License-Identifier: GPL-3.0-or-later
// What a fill came to, in numbers.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/particles.h"
#include "mesh/surface.h"

namespace sinew {

/// How the particles touch each other: pairs closer than 2.2 r.
struct Contacts {
  std::vector<std::int32_t> neighbours;        ///< per particle
  std::array<std::size_t, 13> histogram = {};  ///< particles with 0, 1, .. 12 neighbours
  double smallest = 0, mean = 0;  ///< distance to the nearest one over 2r; 0 where nothing touches
};

struct FillReport {
  std::size_t particles = 0;
  std::size_t sites = 0;            ///< tested
  std::size_t ties = 0;             ///< sites on the surface: outside
  double radius = 0;                ///< m
  double mass = 0;                  ///< of one particle, kg
  double mesh_volume = 0;           ///< m^3
  double packed_volume = 0;         ///< N V0, m^3
  Vec3 box_size = Vec3::Zero();     ///< of the mesh, m
  Vec3 centre = Vec3::Zero();       ///< of mass, of the particles, m
  Vec3 mesh_centre = Vec3::Zero();  ///< of mass, of the mesh's volume, m
  std::array<std::size_t, 13> histogram = {};
  double smallest_distance = 0, mean_distance = 0;  ///< as in Contacts
  int bodies = 0, cavities = 0;
  CleaningCounts cleaning;
  double seconds_reading = 0, seconds_cleaning = 0, seconds_tree = 0, seconds_inside = 0,
         seconds_report = 0;
};

/// A line of the report. The value is a number, or numbers in brackets: JSON as it stands.
struct ReportRow {
  std::string key, value, unit;
};

Contacts contacts_of(const Particles& particles);

/// The centre of mass of the enclosed volume, m.
Vec3 centre_of_volume(const Triangles& surface);

/// The report for people and scripts, `particles` first. Counts of defects only where not 0.
std::vector<ReportRow> rows_of(const FillReport& report);

}  // namespace sinew
