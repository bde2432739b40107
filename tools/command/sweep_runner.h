// SPDX-License-Identifier: GPL-3.0-or-later
// Runs the runs of a sweep side by side, each by programs of its own.
//
//     const Exit exit = run_all(sweep, missing, foreseen, how, common);
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <sinew/io/single_files.h>
#include <sinew/settings/settings.h>
#include <sinew/study/sweep/sweep.h>
#include "command/command.h"

namespace sinew {

/// What a run will take.
struct Foreseen {
  std::size_t particles = 0;
  std::int64_t steps = 0;
  double seconds = 0;                  ///< processor time, as such steps and frames usually take
  std::uint64_t memory = 0, disk = 0;  ///< bytes
};

struct RunnerOptions {
  int jobs = 1, threads = 1;  ///< runs at a time; threads of each
  double memory = 0;          ///< bytes that the runs at work may take together
  double seconds = 0;         ///< wall time of all, as foreseen
  double needed = 0;          ///< bytes of memory that runs at work take at most
  double disk = 0;            ///< bytes on the disk, at most
  double timeout = 0;         ///< s of wall time for a run; 0: none
  /// Whether each run is worth nothing without the others: one that fails ends them, and no state
  /// of theirs but their own is kept. They are simulated alone.
  bool together = false;
  bool force = false;  ///< runs begin anew
};

/// What runs will take: their bodies are filled, those that several have once.
class Forecast {
 public:
  /// Throws bad input, with the scene's line.
  Foreseen of(Settings settings);

 private:
  std::map<std::string, BodyFile> bodies_;  ///< bodies by the origin of their filling
};

/// `jobs` runs at a time (0: as many as are foreseen to end soonest), which share the cores, within
/// `memory` (bytes; 0: most of what is free).
RunnerOptions packed(const Sweep& sweep, const std::vector<Foreseen>& runs, const Common& common,
                     int jobs = 0, double memory = 0);

/// "48 runs of 48 to do: 0:50 with 2 at a time, ...".
std::string plan_text(const Sweep& sweep, std::size_t runs, const RunnerOptions& how);

/// Simulates and measures the runs of these numbers, the longest first. A run that fails is
/// recorded as such, and the others go on. Returns done, interrupted, or not written where the disk
/// is full; of runs that belong together, the exit code of the one that failed.
Exit run_all(const Sweep& sweep, const std::vector<std::size_t>& numbers,
             const std::vector<Foreseen>& foreseen, const RunnerOptions& how, const Common& common);

}  // namespace sinew
