// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-tables NAME: prints a table of the README files as Markdown. For developers; not installed.
#include <algorithm>
#include <string>

#include <sinew/core/arrays.h>
#include <sinew/core/capabilities.h>
#include <sinew/core/options.h>
#include <sinew/core/text.h>
#include <sinew/io/series_table.h>
#include <sinew/metrics/bone_metrics.h>
#include <sinew/metrics/sections.h>
#include <sinew/metrics/table.h>
#include "command/command.h"
#include "command/results.h"
#include "command/settings_list.h"

namespace {

using namespace sinew;

std::string arrays_markdown() {
  std::string text =
      "| series | on | array | components | unit | meaning |\n|---|---|---|---|---|---|\n";
  for (const WrittenArray& array : written_arrays()) {
    std::string components;
    for (const std::string_view name : array.components)
      (components += components.empty() ? "" : " ") += name;
    text += markdown_row({array.series, place_text(array.place),
                          '`' + std::string(array.name) + '`', components, array.unit, array.help});
  }
  return text;
}

std::string series_markdown() {
  std::string text = "| series | cells | asked for by | contents |\n|---|---|---|---|\n";
  for (const SeriesRow& series : series_table())
    text += markdown_row({'`' + std::string(series.name) + '`', cells_text(series.cells),
                          series.asked_by.empty() ? "" : '`' + std::string(series.asked_by) + '`',
                          series.contents});
  return text;
}

template <class Row>
std::string metric_row(const Row& metric) {
  return markdown_row(
      {'`' + std::string(metric.name) + '`', metric.unit, metric.help, metric.formula});
}

std::string metrics_markdown() {
  std::string text = "| metric | unit | meaning | formula |\n|---|---|---|---|\n";
  for (const Metric& metric : metrics_table()) text += metric_row(metric);
  for (const RunMetric& metric : run_metrics_table()) text += metric_row(metric);
  return text;
}

std::string bones_markdown() {
  std::string text = "| metric | unit | meaning | formula |\n|---|---|---|---|\n";
  for (const BoneMetric& metric : bone_metrics_table()) text += metric_row(metric);
  return text;
}

std::string sections_markdown() {
  std::string text = "| metric | unit | meaning | formula |\n|---|---|---|---|\n";
  for (const SectionMetric& metric : section_metrics_table()) text += metric_row(metric);
  return text;
}

/// A feature with what it is part of: Newton's method finds equilibria.
Features implied_by(Feature feature) {
  if (feature == Feature::newton) return {feature, Feature::equilibria};
  return {feature};
}

/// Rows are features, columns who steps or meshes a scene; "no" where the two exclude each other.
std::string capabilities_markdown() {
  using enum Feature;
  constexpr Feature columns[] = {cells,      lists,  single_precision, groups,
                                 equilibria, newton, lammps,           elements};
  const auto table = feature_table();
  std::string text = "| feature | key |", line = "\n|---|---|";
  for (const Feature column : columns) {
    ((text += ' ') += table[static_cast<std::size_t>(column)].words) += " |";
    line += "---|";
  }
  text += line + '\n';
  for (const FeatureRow& row : table) {
    std::string keys, cells_of_row;
    for (const std::string_view key : row.keys)
      keys += (keys.empty() ? "`" : ", `") + std::string(key) + '`';
    for (const Feature column : columns) {
      const Features with_column = implied_by(column), with_row = implied_by(row.feature);
      const auto excludes = [](const Features& those, const Features& others) {
        return std::any_of(those.begin(), those.end(),
                           [&](Feature one) { return conflict_with(one, others).has_value(); });
      };
      const bool excluded = excludes(with_column, with_row) || excludes(with_row, with_column);
      cells_of_row += excluded ? " no |" : row.feature == column ? " |" : " yes |";
    }
    if (cells_of_row.find("no") != std::string::npos)
      text.append("| ").append(row.words).append(" | ").append(keys).append(" |").append(
          cells_of_row + '\n');
  }
  return text;
}

std::string presets_markdown() {
  std::string text =
      "| preset | Young's modulus | density, kg/m^3 | Poisson's ratio | damping ratio | what | "
      "source |\n"
      "|---|--:|--:|--:|--:|---|---|\n";
  for (const MaterialPreset& preset : material_presets())
    text += markdown_row({'`' + std::string(preset.name) + '`',
                          quantity_text(preset.young_modulus, "Pa"), number_text(preset.density),
                          number_text(preset.poisson_ratio), number_text(preset.damping_ratio),
                          preset.what, preset.source});
  return text;
}

std::string table_named(const std::string& name) {
  if (name == "settings") return settings_markdown();
  if (name == "manual") return settings_manual();
  if (name == "arrays") return arrays_markdown();
  if (name == "series") return series_markdown();
  if (name == "metrics") return metrics_markdown();
  if (name == "bones") return bones_markdown();
  if (name == "sections") return sections_markdown();
  if (name == "capabilities") return capabilities_markdown();
  if (name == "presets") return presets_markdown();
  throw bad_input("no table is named '" + name + "'",
                  "write sinew-tables settings, arrays, series, metrics, bones, sections, "
                  "capabilities or presets");
}

}  // namespace

int main(int argc, char** argv) {
  return run_reporting_errors([&] {
    print_out(table_named(argc == 2 ? argv[1] : ""));
    return Exit::done;
  });
}
