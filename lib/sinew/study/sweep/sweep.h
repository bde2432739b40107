// SPDX-License-Identifier: GPL-3.0-or-later
// The runs of a study: what each is, where it lies, and how far it has come. Everything that is
// known of a run lies in its folder, so that a sweep goes on wherever it was ended.
//
//     const Sweep sweep = plan_sweep(read_sweep("stiffness.yaml"), "out/stiffness");
//     for (const SweepRun& run : sweep.runs)
//       if (state_of(sweep, run).status == RunStatus::missing) start(run);
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/run/run_folder.h>
#include <sinew/settings/settings.h>
#include <sinew/study/sweep/sweep_file.h>

namespace sinew {

struct SweepRun {
  std::vector<std::string> values;  ///< values of the varied keys
  std::vector<Override> overrides;  ///< with those that all runs have
  std::string name;                 ///< folder below runs/: the values, and a hash of the scene
  std::string files;                ///< hash of the contents of mesh, rig and clip
};

struct Sweep {
  SweepFile file;
  std::filesystem::path folder;
  std::vector<SweepRun> runs = {};
  std::filesystem::path below = "runs";  ///< where in the folder the runs lie

  RunFolder folder_of(const SweepRun& run) const { return {folder / below / run.name}; }
};

/// Reads the scene of each run; the current folder is that of the study. Throws bad input, with the
/// line of the study, for a value that the scene does not take, for two settings that are one, and
/// for two runs of the same scene.
Sweep plan_sweep(SweepFile file, std::filesystem::path folder);

/// The settings of a run.
Settings settings_of(const Sweep& sweep, const SweepRun& run);

enum class RunStatus { missing, finished, failed };
std::string_view word_of(RunStatus status);  ///< "missing"

struct RunState {
  RunStatus status = RunStatus::missing;
  std::string reason;          ///< why it failed, one line
  double seconds = 0;          ///< wall time
  std::string files, program;  ///< hash of files and version of sinew, at the time
};

RunState state_of(const Sweep& sweep, const SweepRun& run);
/// Throws not written.
void write_state(const Sweep& sweep, const SweepRun& run, const RunState& state);

/// Makes a run one that is missing.
void forget_state(const Sweep& sweep, const SweepRun& run);

/// Throws bad input where a finished run is of another mesh, rig, clip or version of sinew.
void refuse_changed(const Sweep& sweep, const SweepRun& run, const RunState& state);

/// Names of folders of runs that are not in the study.
std::vector<std::string> strangers_of(const Sweep& sweep);

/// Whether particles of a moment are there.
bool has_frames(const RunFolder& run);

/// Whether a run that has ended lacks frames, so that it cannot be measured again.
bool lacks_frames(const RunFolder& run);

/// Removes the frames of a run but those of its last moment, or all of them; also those that a
/// removal which was ended has left. Throws not written.
void remove_frames(const RunFolder& run, KeptFrames keep);

}  // namespace sinew
