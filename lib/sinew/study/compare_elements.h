// SPDX-License-Identifier: GPL-3.0-or-later
// Compares a run with a result of finite elements, point by point: the elements' displacement at
// the place of each particle at rest, at the times that both have.
//
//     const ElementComparison compared = compare_elements("out/beam", "beam.frd", {},
//     "out/compared"); const double apart = compared.frames.back().max_relative;
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/metrics/comparison.h>
#include <sinew/metrics/report/charts.h>
#include <sinew/metrics/report/report.h>
#include <sinew/run/measure_run.h>

namespace sinew {

/// Over all particles, whose displacement from rest is u and that of the elements there w.
struct ElementFrame {
  double time = 0;
  double largest_elements = 0, largest = 0;   ///< max |w|, max |u|, m
  double rms = 0, max = 0;                    ///< root mean square and largest |u - w|, m
  double rms_relative = 0, max_relative = 0;  ///< over max |w|
  double worst_particle = 0;                  ///< id of the particle that is farthest off
  double von_mises_95_elements = not_measured, von_mises_95 = not_measured;  ///< Pa
};

struct ElementColumn {
  std::string_view name, unit, help;
  double ElementFrame::*value;
};

/// The columns of reference.csv, in its order.
std::span<const ElementColumn> element_columns();

/// Displacements of a probe of the run's scene, one per frame, m.
struct ComparedProbe {
  std::string name;
  Points elements, run;
};

/// Force of a support of the run's scene on the body, N, of elements with the loads on held nodes,
/// and mean displacement of its part, m, one per frame.
struct ComparedSupport {
  std::string name;
  Points elements_force, run_force, elements_displacement, run_displacement;
};

struct ElementComparison {
  std::string name;  ///< name of the result's file
  std::size_t elements = 0, nodes = 0, particles = 0;
  std::vector<ElementFrame> frames;
  std::vector<ComparedProbe> probes;
  std::vector<ComparedSupport> supports;  ///< supports whose part elements have
  RunComparison metrics;  ///< first: the run's body, moved by the elements; second: the run
};

/// Writes reference.csv, reference.json, compare.csv, metrics.json and report.html into `out`,
/// which is created. Throws bad input for a folder that is no run, as read_frd() does, for a result
/// of another body or of no time of the run's frames, and where `out` holds a run; not written.
ElementComparison compare_elements(const std::filesystem::path& run,
                                   const std::filesystem::path& result, const MeasureOptions& how,
                                   const std::filesystem::path& out);

/// The distances in parts of the largest displacement, then each probe along each axis.
std::vector<Chart> element_charts(const ElementComparison& compared);
/// Plots supports that move one way: their largest force over their largest displacement.
std::vector<LawCurve> element_curves(const ElementComparison& compared);

/// A row per frame: the columns above, then of each probe its displacement, and of each support
/// its force, by the elements and in the run.
std::string reference_csv(const ElementComparison& compared);
/// The counts and the same rows, for scripts.
std::string reference_json(const ElementComparison& compared);

}  // namespace sinew
