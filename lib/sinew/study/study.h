// SPDX-License-Identifier: GPL-3.0-or-later
// Measures several runs and puts their results side by side. Where the runs are one scene with
// particles of several sizes, each result has a limit for small ones.
//
//     const Study study = study_runs({"out/coarse", "out/middle", "out/fine"}, {});
//     write_study(study, "out/study");
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <sinew/metrics/report/report.h>
#include <sinew/run/measure_run.h>
#include <sinew/study/compare_runs.h>
#include <sinew/study/convergence.h>

namespace sinew {

struct StudiedRun {
  std::string name;
  double radius = 0;  ///< radius of a particle, m
  std::size_t particles = 0;
  double seconds = not_measured;       ///< time that stepping took, s
  std::vector<FrameMetrics> frames;    ///< at the times that all runs have
  std::vector<MachineColumn> machine;  ///< columns of supports, loads and probes at those times
};

/// One number of each run.
struct StudiedResult {
  std::string name;  ///< a metric, or "grip: force_z"
  std::string kind;  ///< "final" and "worst" over the frames, "largest" in size; "run" of all of it
  std::string unit;
  std::vector<double> values;  ///< one per run
  ContinuumLimit limit;        ///< nothing unless Study::by_radius, and the values converge

  bool measured() const;  ///< whether every run has a value
};

struct Study {
  std::vector<StudiedRun> runs;
  std::vector<DifferingSetting> settings;
  bool by_radius = false;  ///< the scenes differ in the radius alone
  std::vector<StudiedResult> results;
  std::vector<std::string> remarks;  ///< sentences on what could not be compared, and why
};

/// Studies two runs or more. Throws bad input for folders that are not runs, for one that is named
/// twice, and for runs without a common time; what measuring throws.
Study study_runs(const std::vector<std::filesystem::path>& folders, const MeasureOptions& how);

}  // namespace sinew
