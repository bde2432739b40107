// SPDX-License-Identifier: GPL-3.0-or-later
// run.json: what was run, its progress, and the duration of each stage. Every tool adds its part.
//
//     record_stage(folder, "measure", stopwatch.seconds());
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include <sinew/core/error.h>
#include <sinew/run/run_folder.h>

namespace sinew {

/// The content of run.json. Throws bad input, naming the file, where it is not a record of a run.
nlohmann::ordered_json read_record(const RunFolder& folder);

/// Replaces run.json. Throws not written.
void write_record(const RunFolder& folder, const nlohmann::ordered_json& record);

/// seconds.STAGE of run.json; 0: not known. Throws bad input where that is not a record.
double seconds_of(const RunFolder& folder, const std::string& stage);
/// Writes seconds.STAGE into run.json, unless a run is in progress in the folder.
void record_stage(const RunFolder& folder, const std::string& stage, double seconds);

/// "status" of the run: running, finished, stopped, unstable, failed; "" without a record.
std::string status_of(const RunFolder& folder);

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
