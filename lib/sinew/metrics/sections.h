// SPDX-License-Identifier: GPL-3.0-or-later
// sections.csv: how the body's cross sections change. A section is the ring in which a plane across
// a bone cuts the skin at rest; its points then follow the faces they lie on. A ring that a twist
// pinches (candy wrapper) loses area, one that bulges gains area.
//
//     const auto rows = measure_sections(rest.sections, state.surface_points, state.time);
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/core/triangles.h>
#include <sinew/metrics/frame.h>
#include <sinew/rig/skeleton.h>

namespace sinew {

/// A point of an edge: at `fraction` of the way from one end to the other.
struct EdgePoint {
  int from = 0, to = 0;  ///< points of the surface
  double fraction = 0;
};

struct Section {
  int bone = 0;
  double along = 0;             ///< where it crosses the bone: 0 at the head, 1 at the tail
  bool joint = false;           ///< it lies in a joint zone
  double area = 0;              ///< at rest, m^2
  std::vector<EdgePoint> ring;  ///< counter-clockwise about the bone's axis
};

inline constexpr int sections_per_bone = 16;  ///< steps from head to tail, both ends included

/// Finds the rings around each bone at even steps; none where the bone is outside the skin. The
/// smallest of nested rings counts. `near_joint` returns whether a point (at rest, m) lies in a
/// joint zone.
std::vector<Section> make_sections(const Triangles& surface, std::span<const Bone> bones,
                                   const std::function<bool(const Vec3&)>& near_joint);

/// Present area of the ring: of its projection along the direction in which that is largest.
double area_of(const Section& section, const Points& surface_points);

struct SectionMetrics {
  double time = not_measured, bone = not_measured, along = not_measured, joint = not_measured;
  double area = not_measured, area_ratio = not_measured;
};

struct SectionMetric {
  std::string_view name, unit, help, formula;
  double SectionMetrics::*value;
};

std::span<const SectionMetric> section_metrics_table();

/// One for each section, in their order.
std::vector<SectionMetrics> measure_sections(std::span<const Section> sections,
                                             const Points& surface_points, double time);

/// The whole file, in the format of metrics_csv().
std::string sections_csv(std::span<const SectionMetrics> rows);

}  // namespace sinew
