// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/run/run_record.h>

#include <unistd.h>
#include <algorithm>
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include <sinew/core/error.h>
#include <sinew/core/file.h>
#include <sinew/core/json.h>
#include <sinew/core/system.h>
#include <sinew/core/text.h>
#include <sinew/io/paraview/view_state.h>
#include <sinew/io/series_table.h>

namespace sinew {
namespace {

using Json = nlohmann::ordered_json;

std::string host_name() {
  std::array<char, 256> name{};
  ::gethostname(name.data(), name.size() - 1);
  return name.data();
}

bool is_seconds(const Json& value) {
  return value.is_object() && std::all_of(value.begin(), value.end(),
                                          [](const auto& spent) { return spent.is_number(); });
}

bool is_range(const Json& value) {
  return value.is_array() && value.size() == 2 && value[0].is_number() && value[1].is_number() &&
         value[0].get<double>() <= value[1].get<double>();
}

bool is_count(const Json& value) {
  return value.is_number_unsigned() && value.get<std::uint64_t>() <= 1'000'000'000;
}

/// Whether it is a record of sinew, with values of the right type where a resumed run reads them.
bool is_record(const Json& record) {
  return record.is_object() && record.value("program", Json()) == "sinew" &&
         record.value("status", Json("")).is_string() &&
         record.value("started", Json("")).is_string() &&
         is_seconds(record.value("seconds", Json::object())) &&
         is_count(record.value("resumed", Json(0u)));
}

}  // namespace

Json read_record(const RunFolder& folder) {
  auto record = own_json<Json>(read_file(folder.record()));
  if (is_record(record)) return record;
  throw bad_input(Place{folder.record().string()}, "is not the record of a run",
                  "run the scene again with --force");
}

void write_record(const RunFolder& folder, const Json& record) {
  const std::string text = json_text(record, 2) + '\n';
  NewFile file(folder.record());
  file.write(text.data(), text.size());
  file.finish(Durability::synced);
}

double seconds_of(const RunFolder& folder, const std::string& stage) {
  return read_record(folder).value("seconds", Json::object()).value(stage, 0.0);
}

Json json_of(const ValueRanges& ranges) {
  Json json = Json::object();
  for (const auto& [quantity, range] : ranges) json[quantity] = {range.low, range.high};
  return json;
}

namespace {

ValueRanges ranges_in(const Json& record) {
  constexpr std::size_t most = 1000;  // more than there are quantities: a record from elsewhere
  ValueRanges ranges;
  const auto all = record.find("ranges");
  if (all == record.end() || !all->is_object() || all->size() > most) return ranges;
  for (const auto& [quantity, ends] : all->items())
    if (is_range(ends)) ranges[quantity] = {ends[0], ends[1]};
  return ranges;
}

}  // namespace

ValueRanges recorded_ranges(const RunFolder& folder) {
  std::error_code unreachable;
  if (!std::filesystem::exists(folder.record(), unreachable)) return {};
  try {
    return ranges_in(read_record(folder));
  } catch (const Error&) {  // a damaged record leaves the frames as they are
    return {};
  }
}

void record_stage(const RunFolder& folder, const std::string& stage, double seconds,
                  const FoundRanges& found) {
  std::optional<FolderLock> lock;
  try {
    lock.emplace(folder);
  } catch (const Error&) {
    return;  // a run in progress writes its own record; a read-only folder keeps its record
  }
  auto record = read_record(folder);
  if (!record["seconds"].is_object()) record["seconds"] = Json::object();
  record["seconds"][stage] = seconds;
  // A run that has gone on since it was opened has other ranges.
  if (record.value("frames", Json()) == Json(found.frames)) {
    ValueRanges all = ranges_in(record);
    all.insert(found.ranges.begin(), found.ranges.end());
    if (!all.empty()) record["ranges"] = json_of(all);
  }
  write_record(folder, record);
}

void renew_view(const RunFolder& folder, const ValueRanges& before) {
  std::error_code unreachable;
  if (!std::filesystem::exists(folder.view(), unreachable) || is_foreign_state(folder.view()) ||
      status_of(folder) == "running")
    return;
  const std::string state = read_file(folder.view());
  const ValueRanges now = recorded_ranges(folder);
  const auto shows_new = [&](const auto& range) {
    return !before.contains(range.first) &&
           state.find('"' + range.first + ".PVLookupTable\"") != std::string::npos;
  };
  if (std::none_of(now.begin(), now.end(), shows_new)) return;
  try {
    write_view_state(folder.path, folder.view(), now);
  } catch (const Error&) {
    return;  // the one that is there still shows the run, in a range of its own
  }
}

std::string status_of(const RunFolder& folder) {
  std::error_code unreachable;
  if (!std::filesystem::exists(folder.record(), unreachable)) return "";
  const auto record = read_record(folder);
  const auto status = record.find("status");
  return status != record.end() && status->is_string() ? status->get<std::string>() : "";
}

std::vector<std::string> warnings_in(const Json& record) {
  std::vector<std::string> warnings;
  for (const Json& one : record.value("warnings", Json::array()))
    if (one.is_string()) warnings.push_back(one);
  return warnings;
}

std::string scene_name(const RunFolder& folder) {
  constexpr std::string_view usual = "scene";  // name in the folder of a run
  Json words;
  if (std::filesystem::exists(folder.record()))
    words = read_record(folder).value("command", Json::array());
  for (const auto& word : words) {
    if (!word.is_string()) continue;
    const std::filesystem::path path = word.get<std::string>();
    const bool is_scene = path.extension() == ".yaml" || path.extension() == ".yml";
    if (is_scene && path.stem() != usual) return path.stem();
  }
  return std::filesystem::absolute(folder.path / ".").lexically_normal().parent_path().filename();
}

std::string modulus_text(const nlohmann::ordered_json& entry) {
  const auto pascals = [&](const char* key) { return quantity_text(entry.value(key, 0.0), "Pa"); };
  const std::string asked =
      entry.contains("young_modulus_asked") ? "; asked: " + pascals("young_modulus_asked") : "";
  return pascals("young_modulus") + ", by a stress of " + pascals("stress") + " at a strain of " +
         three_digits(entry.value("strain", 0.0)) + asked;
}

Error without_frames(const RunFolder& folder) {
  const Place place{folder.path.string()};
  const std::string status = status_of(folder);
  if (status == "running" || status == "stopped")
    return bad_input(place, "the run has no frames yet",
                     "wait for the first, or go on with --resume where it has stopped");
  return bad_input(
      place, "the run has no frames",
      "see why in " + folder.log().string() + ", and run the scene again with --force");
}

void refuse_without_frames(const RunFolder& folder) {
  std::error_code unreachable;
  for (const char* file : {"particles.pvd", "particles/particles_000000.vtu"})
    if (std::filesystem::exists(folder.path / file, unreachable)) return;
  throw without_frames(folder);
}

Json begin_record(const std::vector<std::string>& command) {
  Json record;
  record["program"] = "sinew";
  record["schema_version"] = run_schema_version;
  record["version"] = version();
  record["status"] = "running";
  record["command"] = command;
  record["host"] = host_name();
  record["cores"] = std::thread::hardware_concurrency();
  record["started"] = time_text("%Y-%m-%dT%H:%M:%SZ", Zone::utc);
  return record;
}

}  // namespace sinew
