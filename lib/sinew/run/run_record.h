// SPDX-License-Identifier: GPL-3.0-or-later
// run.json: what was run, its progress, and the duration of each stage. Every tool adds its part.
//
//     record_stage(folder, "measure", stopwatch.seconds());
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include <sinew/core/error.h>
#include <sinew/core/value_range.h>
#include <sinew/run/run_folder.h>

namespace sinew {

/// The content of run.json. Throws bad input, naming the file, where it is not a record of a run.
nlohmann::ordered_json read_record(const RunFolder& folder);

/// Replaces run.json. Throws not written.
void write_record(const RunFolder& folder, const nlohmann::ordered_json& record);

/// seconds.STAGE of run.json; 0: not known. Throws bad input where that is not a record.
double seconds_of(const RunFolder& folder, const std::string& stage);

/// Ranges of quantities that were found in so many frames.
struct FoundRanges {
  ValueRanges ranges;
  std::size_t frames = 0;
};

/// Writes seconds.STAGE into run.json, and those of the ranges that it has not yet if they are of
/// all frames of the run, unless a run is in progress in the folder.
void record_stage(const RunFolder& folder, const std::string& stage, double seconds,
                  const FoundRanges& found);
/// "ranges" of run.json: of quantities over all frames; empty where none have been found, or the
/// record is damaged.
ValueRanges recorded_ranges(const RunFolder& folder);
nlohmann::ordered_json json_of(const ValueRanges& ranges);

/// Writes the state for ParaView anew, with the run's ranges, where one that sinew has written is
/// in the folder of a run that has ended and shows a quantity whose range was not known before.
void renew_view(const RunFolder& folder, const ValueRanges& before);

/// "status" of the run: running, finished, stopped, unstable, failed; "" without a record.
std::string status_of(const RunFolder& folder);

/// "warnings" of run.json: what is doubtful in the run, each with its cure, the shortest first.
std::vector<std::string> warnings_in(const nlohmann::ordered_json& record);

/// The name of the scene's file without its ending, from the command in run.json; the folder's
/// where that has none, or only "scene".
std::string scene_name(const RunFolder& folder);

/// Young's modulus as a probe shows it, beside the one asked for: an entry of moduli_at_probes.
std::string modulus_text(const nlohmann::ordered_json& entry);

/// For a run whose first frame is still to come, or never came: says so, and what to do.
Error without_frames(const RunFolder& folder);
/// Throws it where nothing of a first frame is there.
void refuse_without_frames(const RunFolder& folder);

/// A record with version, command line, host and start time filled in.
nlohmann::ordered_json begin_record(const std::vector<std::string>& command);

}  // namespace sinew
