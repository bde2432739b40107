// SPDX-License-Identifier: GPL-3.0-or-later
// run.json: what was run, how far it came, and how long each stage took. Every tool adds its part.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include <sinew/run/run_folder.h>

namespace sinew {

/// What run.json holds. Throws bad input, naming the file, when it is no record of a run.
nlohmann::ordered_json read_record(const RunFolder& folder);

/// Replaces run.json. Throws not written.
void write_record(const RunFolder& folder, const nlohmann::ordered_json& record);

/// Writes seconds.STAGE into run.json, unless a run is going on in the folder.
void record_stage(const RunFolder& folder, const std::string& stage, double seconds);

/// "status" of the run: running, finished, stopped, unstable, failed; "" without a record.
std::string status_of(const RunFolder& folder);

/// A record with version, command line, host and start time filled in.
nlohmann::ordered_json begin_record(const std::vector<std::string>& command);

}  // namespace sinew
