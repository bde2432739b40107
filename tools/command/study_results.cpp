// SPDX-License-Identifier: GPL-3.0-or-later
#include "command/study_results.h"

#include <cmath>
#include <string>

#include <sinew/core/text.h>
#include "command/results.h"

namespace sinew {
namespace {

/// "grip.force_z.final": words without spaces.
std::string key_of(const StudiedResult& result) {
  std::string key = result.name;
  if (const auto colon = key.find(": "); colon != std::string::npos) key.replace(colon, 2, ".");
  return key + '.' + result.kind;
}

std::string in_words(const StudiedResult& result) {
  std::string words = three_digits(result.limit.value);
  words += " ± " + three_digits(result.limit.error);
  if (!result.unit.empty()) words += ' ' + result.unit;
  if (std::isfinite(result.limit.order)) words += ", order " + three_digits(result.limit.order);
  return words;
}

nlohmann::ordered_json value_of(const StudiedResult& result) {
  nlohmann::ordered_json value{{"values", result.values}};
  if (std::isfinite(result.limit.value)) {
    value["limit"] = result.limit.value;
    value["error"] = result.limit.error;
    if (std::isfinite(result.limit.order)) value["order"] = result.limit.order;
  }
  return value;
}

/// What a testing machine reads, or else the volume and the distance from the bones.
bool is_told(const StudiedResult& result, bool machine) {
  if (machine) return result.name.find(": ") != std::string::npos && result.kind == "final";
  return result.kind == "worst" &&
         (result.name == "volume_error" || result.name == "pose_error_far_rms");
}

}  // namespace

void print_study(const Study& study, const std::filesystem::path& folder, const Common& common) {
  Results results;
  results.add("runs", study.runs.size());
  results.add("frames", study.runs.front().frames.size());
  if (!study.remarks.empty()) results.add("remarks", study.remarks);
  const bool machine = !study.runs.front().machine.empty();
  for (const StudiedResult& one : study.results) {
    results.add_value(key_of(one), value_of(one));
    if (study.by_radius && is_told(one, machine) && std::isfinite(one.limit.value))
      results.add_headline(key_of(one), in_words(one));
  }
  results.add_headline("report", (folder / "report.html").string());
  results.print(common);
}

}  // namespace sinew
