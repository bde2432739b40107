// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/study/sweep/sweep_table.h>

#include <nlohmann/json.hpp>

#include <sinew/core/file.h>
#include <sinew/core/json.h>
#include <sinew/io/series.h>
#include <sinew/settings/values.h>

namespace sinew {
namespace {

namespace fs = std::filesystem;

/// Whether it is there, and no older than what it is made from.
bool is_recent(const fs::path& file, const fs::path& source) {
  std::error_code none;
  const auto written = fs::last_write_time(file, none);
  return !none && written >= fs::last_write_time(source, none);
}

/// Numbers as fields, and all values as text in what is told of the file.
void add_values(const Sweep& sweep, const SweepRun& run, Dataset& moment) {
  auto meta = parsed_json<nlohmann::ordered_json>(moment.meta);
  if (!meta.is_object()) meta = nlohmann::ordered_json::object();
  meta["run"] = run.name;
  for (std::size_t q = 0; q < run.values.size(); ++q) {
    const std::string& path = sweep.file.vary[q].path;
    meta["values"][path] = run.values[q];
    if (const auto number = parse_number(run.values[q]))
      moment.field_columns.push_back(column(path, std::vector<double>{*number}));
  }
  moment.meta = json_text(meta);
}

}  // namespace

void write_moments(const Sweep& sweep, const SweepTable& table) {
  std::vector<PvdRow> rows;
  for (std::size_t k = 0; k < table.size(); ++k) {
    const SweepRun& run = sweep.runs[k];
    const fs::path folder = sweep.folder_of(run).path, list = folder / "particles.pvd";
    if (table[k].state.status != RunStatus::finished || !fs::exists(list)) continue;
    const std::vector<PvdRow> frames = read_pvd(list);
    if (frames.empty()) continue;
    const std::string file = "moments/" + run.name + ".vtu";
    rows.push_back({static_cast<double>(k), file});
    const fs::path source = folder / frames.back().file;
    if (is_recent(sweep.folder / file, source)) continue;
    create_folder(sweep.folder / "moments");
    Dataset moment = read_vtu(source);
    add_values(sweep, run, moment);
    write_vtu(sweep.folder / file, moment, {.series = "particles"});
  }
  if (!rows.empty()) return write_file(sweep.folder / "sweep.pvd", pvd_text(rows));
  fs::remove(sweep.folder / "sweep.pvd");
  fs::remove_all(sweep.folder / "moments");
}

}  // namespace sinew
