// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/study/study_files.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include <sinew/core/csv.h>
#include <sinew/core/file.h>
#include <sinew/core/json.h>
#include <sinew/core/text.h>
#include <sinew/run/run_folder.h>

namespace sinew {
namespace {

using Json = nlohmann::ordered_json;
constexpr int schema_version = 1;

std::string cell(double value) { return std::isnan(value) ? "nan" : number_text(value); }

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json numbers(const std::vector<double>& values) {
  Json all = Json::array();
  for (const double value : values) all.push_back(number(value));
  return all;
}

}  // namespace

std::string study_csv(const Study& study) {
  std::string text = "name,kind,unit";
  for (const StudiedRun& run : study.runs) text += ',' + quoted_cell(run.name);
  text += ",limit,error,order\n";
  for (const StudiedResult& result : study.results) {
    text += quoted_cell(result.name) + ',' + result.kind + ',' + quoted_cell(result.unit);
    for (const double value : result.values) text += ',' + cell(value);
    for (const double value : {result.limit.value, result.limit.error, result.limit.order})
      text += ',' + cell(value);
    text += '\n';
  }
  return text;
}

std::string study_json(const Study& study) {
  Json file{{"schema_version", schema_version},
            {"frames", study.runs.front().frames.size()},
            {"by_radius", study.by_radius},
            {"remarks", study.remarks},
            {"runs", Json::array()},
            {"settings", Json::array()},
            {"results", Json::array()}};
  for (const StudiedRun& run : study.runs)
    file["runs"].push_back({{"name", run.name},
                            {"radius", run.radius},
                            {"particles", run.particles},
                            {"seconds", number(run.seconds)}});
  for (const DifferingSetting& one : study.settings)
    file["settings"].push_back(
        {{"section", one.section}, {"name", one.name}, {"values", one.values}});
  for (const StudiedResult& one : study.results)
    file["results"].push_back({{"name", one.name},
                               {"kind", one.kind},
                               {"unit", one.unit},
                               {"values", numbers(one.values)},
                               {"limit", number(one.limit.value)},
                               {"error", number(one.limit.error)},
                               {"order", number(one.limit.order)}});
  return json_text(file, 2) + '\n';
}

void write_study(const Study& study, const std::filesystem::path& out) {
  create_folder(out);
  write_file(out / "study.csv", study_csv(study));
  write_file(out / "study.json", study_json(study));
  write_file(out / "report.html", study_html(study, name_of_run(out)));
}

}  // namespace sinew
