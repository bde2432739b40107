// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/study/sweep/sweep.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include <sinew/core/file.h>
#include <sinew/core/hash.h>
#include <sinew/core/json.h>
#include <sinew/core/system.h>
#include <sinew/core/text.h>
#include <sinew/io/checksums.h>
#include <sinew/io/series.h>
#include <sinew/io/series_table.h>
#include <sinew/run/run_record.h>
#include <sinew/settings/read_scene.h>
#include <sinew/settings/text_file.h>
#include <sinew/settings/write_scene.h>

namespace sinew {
namespace {

namespace fs = std::filesystem;

constexpr int sweep_schema_version = 1;
constexpr std::array<const char*, 3> status_words = {"missing", "finished", "failed"};

/// Without its comments, which another version of sinew may word otherwise.
std::string bare_scene(const Settings& settings, const fs::path& folder) {
  const std::string text = resolved_scene(settings, folder);
  std::string bare;
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = std::min(text.find('\n', from), text.size());
    const std::string line = text.substr(from, end - from);
    bare += line.substr(0, line.find("  # ")) + '\n';
    from = end + 1;
  }
  return bare;
}

/// "young_modulus=5000_radius=0.01" in letters that every file system and shell takes.
std::string label_of(const SweepFile& file, const std::vector<std::string>& values) {
  constexpr std::size_t longest = 80;
  std::string label;
  for (std::size_t k = 0; k < values.size(); ++k)
    label += (k > 0 ? "_" : "") + steps_of(file.vary[k].path).back().key + '=' + values[k];
  for (char& c : label) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    if (!plain && c != '.' && c != '=' && c != '_' && c != '+') c = '-';
  }
  return label.substr(0, longest);
}

/// Hashes the files that a scene names: each is read once for all runs.
class FileHashes {
 public:
  std::string of(const Settings& settings) {
    Hash hash;
    for (const std::string& path : files_of(settings))
      if (fs::is_regular_file(path)) hash.add(of(path));
    return hash_text(hash.value());
  }

 private:
  const std::string& of(const std::string& path) {
    constexpr std::uint64_t largest = std::uint64_t{1} << 36;
    auto [at, fresh] = known_.try_emplace(path);
    if (fresh) {
      Hash own;
      own.add(read_file(path, largest));
      at->second = hash_text(own.value());
    }
    return at->second;
  }

  std::map<std::string, std::string> known_;
};

/// Throws where two keys lead to one setting.
void refuse_same_settings(const SweepFile& file) {
  if (!fs::exists(file.scene))
    throw bad_input(file.scene_place, "there is no scene '" + file.scene.string() + "'",
                    "give its path from the folder of the study");
  const YamlNode scene = parse_yaml(read_text(file.scene), file.scene.string());
  std::map<std::string, const VariedKey*> seen;
  for (const VariedKey& key : file.vary) {
    const auto [at, fresh] = seen.try_emplace(present_path(canonical_path(key.path, scene)), &key);
    if (!fresh)
      throw bad_input(key.place, key.path + " and " + at->second->path + " are one setting",
                      "vary one of them");
  }
}

std::vector<Override> overrides_of(const SweepFile& file, const std::vector<std::string>& values) {
  std::vector<Override> all = file.fixed;
  for (std::size_t k = 0; k < values.size(); ++k)
    all.push_back({file.vary[k].path, values[k], file.vary[k].place.text()});
  return all;
}

[[noreturn]] void refuse_same_runs(const SweepFile& file, const SweepRun& run,
                                   const SweepRun& other) {
  for (std::size_t k = 0; k < run.values.size(); ++k)
    if (run.values[k] != other.values[k])
      throw bad_input(file.vary[k].place,
                      "'" + file.vary[k].path + "' has " + other.values[k] + " and " +
                          run.values[k] + ", which give the same scene",
                      "give each value once");
  throw bad_input(file.vary.front().place, "two runs have the same values",
                  "give each combination once");
}

/// The places of columns of supports, loads and probes, as "grip: force_z" names them, and times.
void check_results(const SweepFile& file, const Settings& settings) {
  std::vector<std::string_view> names;
  for (const SupportSettings& one : settings.supports) names.push_back(one.name);
  for (const LoadSettings& one : settings.loads) names.push_back(one.name);
  for (const SpringSettings& one : settings.world.springs) names.push_back(one.name);
  for (const ProbeSettings& one : settings.probes) names.push_back(one.name);
  for (const AskedResult& asked : file.results) {
    const auto colon = asked.name.find(": ");
    const std::string name = asked.name.substr(0, colon);
    if (colon != asked.name.npos && std::find(names.begin(), names.end(), name) == names.end())
      throw bad_input(asked.place, "the scene has no support, load or probe '" + name + "'",
                      names.empty() ? "ask for metrics alone" : suggestion(name, names));
    const double end = settings.solver.duration;
    if (asked.of == ResultOf::at && !(asked.time >= 0 && asked.time <= end))
      throw bad_input(asked.place, number_text(asked.time) + " s is not a time of the run",
                      "give one from 0 to " + number_text(end) + " s");
  }
}

/// A text of a record from elsewhere; "" where it is none.
std::string text_in(const nlohmann::ordered_json& record, const char* key) {
  const auto found = record.find(key);
  return found != record.end() && found->is_string() ? found->get<std::string>() : "";
}

fs::path state_file(const Sweep& sweep, const SweepRun& run) {
  return sweep.folder_of(run).path / "sweep.json";
}

}  // namespace

std::string_view word_of(RunStatus status) {
  return status_words[static_cast<std::size_t>(status)];
}

Settings settings_of(const Sweep& sweep, const SweepRun& run) {
  return read_scene(sweep.file.scene, run.overrides);
}

Sweep plan_sweep(SweepFile file, fs::path folder) {
  refuse_same_settings(file);
  Sweep sweep{std::move(file), std::move(folder)};
  FileHashes hashes;
  std::map<std::string, std::size_t> known;
  for (std::vector<std::string>& values : values_of(sweep.file)) {
    SweepRun run{values, overrides_of(sweep.file, values), "", ""};
    const Settings settings = settings_of(sweep, run);
    Hash hash;
    hash.add(bare_scene(settings, sweep.file.scene.parent_path()));
    const std::string scene = hash_text(hash.value());
    run.name = label_of(sweep.file, values) + '-' + scene.substr(0, 8);
    run.files = hashes.of(settings);
    check_results(sweep.file, settings);
    const auto [at, fresh] = known.try_emplace(scene, sweep.runs.size());
    if (!fresh) refuse_same_runs(sweep.file, run, sweep.runs[at->second]);
    sweep.runs.push_back(std::move(run));
  }
  return sweep;
}

RunState state_of(const Sweep& sweep, const SweepRun& run) {
  RunState state;
  const fs::path path = state_file(sweep, run);
  if (!fs::exists(path)) return state;
  constexpr std::uint64_t largest = 1 << 20;
  const auto found = parsed_json<nlohmann::ordered_json>(read_file(path, largest));
  if (!found.is_object()) return state;  // torn: the run is done again
  const std::string status = text_in(found, "status");
  for (std::size_t k = 0; k < status_words.size(); ++k)
    if (status == status_words[k]) state.status = static_cast<RunStatus>(k);
  if (state.status == RunStatus::finished && !fs::exists(path.parent_path() / "metrics.csv"))
    return {};
  state.reason = text_in(found, "reason");
  if (found.contains("seconds") && found["seconds"].is_number()) state.seconds = found["seconds"];
  state.files = text_in(found, "files");
  state.program = text_in(found, "program");
  return state;
}

void write_state(const Sweep& sweep, const SweepRun& run, const RunState& state) {
  nlohmann::ordered_json values;
  for (std::size_t k = 0; k < run.values.size(); ++k)
    values[sweep.file.vary[k].path] = run.values[k];
  const nlohmann::ordered_json file{{"schema_version", sweep_schema_version},
                                    {"status", word_of(state.status)},
                                    {"reason", state.reason},
                                    {"seconds", state.seconds},
                                    {"files", state.files},
                                    {"program", state.program},
                                    {"values", values}};
  create_folder(sweep.folder_of(run).path);
  write_file(state_file(sweep, run), json_text(file, 2) + '\n');
}

void forget_state(const Sweep& sweep, const SweepRun& run) { fs::remove(state_file(sweep, run)); }

void refuse_changed(const Sweep& sweep, const SweepRun& run, const RunState& state) {
  if (state.status != RunStatus::finished) return;
  const Place place{sweep.folder_of(run).path.string()};
  const std::string cure = "do it again with --force, or choose another folder with -o";
  if (state.files != run.files)
    throw bad_input(place, "was run with another mesh, rig or clip of the same name", cure);
  if (state.program != version()) throw bad_input(place, "was run by sinew " + state.program, cure);
}

std::vector<std::string> strangers_of(const Sweep& sweep) {
  std::set<std::string> known;
  for (const SweepRun& run : sweep.runs) known.insert(run.name);
  std::vector<std::string> strangers;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(sweep.folder / "runs", none))
    if (const std::string name = entry.path().filename(); !known.contains(name))
      strangers.push_back(name);
  std::sort(strangers.begin(), strangers.end());
  return strangers;
}

bool has_frames(const RunFolder& run) {
  const fs::path list = run.path / "particles.pvd";
  return fs::exists(list) && !read_pvd(list).empty();
}

bool lacks_frames(const RunFolder& run) {
  if (!run.used() || status_of(run) != "finished") return false;
  const nlohmann::ordered_json record = read_record(run);
  std::size_t listed = 0;
  for (const std::string_view name : series_in(run.path))
    listed = std::max(listed, read_pvd(run.path / (std::string(name) + ".pvd")).size());
  const auto frames = record.find("frames");
  return frames != record.end() && frames->is_number_unsigned() &&
         listed < frames->get<std::size_t>();
}

void remove_frames(const RunFolder& run, KeptFrames keep) {
  if (keep == KeptFrames::all) return;
  for (const std::string_view name : series_in(run.path)) {
    const std::string series(name);
    std::vector<PvdRow> rows = read_pvd(run.path / (series + ".pvd"));
    if (keep == KeptFrames::last && rows.size() > 1) rows.erase(rows.begin(), rows.end() - 1);
    if (keep == KeptFrames::metrics) rows.clear();
    keep_frames(run.path, series, rows);
  }
  std::vector<Checksum> kept = read_checksums(run.path);
  const auto is_gone = [&](const Checksum& one) { return !fs::exists(run.path / one.name); };
  if (std::erase_if(kept, is_gone) > 0) Checksums(run.path, kept);
}

}  // namespace sinew
