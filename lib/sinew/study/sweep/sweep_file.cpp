// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/study/sweep/sweep_file.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <sinew/core/text.h>
#include <sinew/metrics/table.h>
#include <sinew/settings/sections.h>
#include <sinew/settings/text_file.h>
#include <sinew/settings/values.h>
#include <sinew/study/sweep/design.h>

namespace sinew {
namespace {

using Kind = YamlNode::Kind;

constexpr std::size_t max_runs = 100'000;

std::string flow_text(const YamlNode& node);

/// The items between commas, each after its key where it has one.
std::string flow_items(const YamlNode& node) {
  std::string text;
  for (std::size_t k = 0; k < node.items.size(); ++k) {
    if (k > 0) text += ", ";
    if (k < node.keys.size()) text += node.keys[k].name + ": ";
    text += flow_text(node.items[k]);
  }
  return text;
}

/// The value as YAML, on one line.
std::string flow_text(const YamlNode& node) {
  if (node.kind == Kind::list) return '[' + flow_items(node) + ']';
  if (node.kind == Kind::map) return '{' + flow_items(node) + '}';
  if (!node.quoted) return node.text;
  std::string text = "\"";
  for (const char c : node.text) {
    if (c == '"' || c == '\\') text += '\\';
    text += c == '\n' ? std::string("\\n") : std::string(1, c);
  }
  return text + '"';
}

const YamlNode& needed(const YamlNode& map, const char* key, const char* cure) {
  const YamlNode* value = map.find(key);
  if (value == nullptr || value->kind == Kind::empty)
    throw bad_input(map.place, std::string(key) + " is missing", cure);
  return *value;
}

double number_at(const YamlNode& map, const char* key, std::optional<double> otherwise = {}) {
  const YamlNode* node = map.find(key);
  if (node == nullptr && otherwise) return *otherwise;
  const auto value =
      node != nullptr && node->kind == Kind::scalar ? parse_number(node->text) : std::nullopt;
  if (!value || !std::isfinite(*value))
    throw bad_input(node ? node->place : map.place, std::string(key) + " must be a number",
                    "write one, as in " + std::string(key) + ": 10");
  return *value;
}

std::size_t count_at(const YamlNode& map, const char* key, double least,
                     std::optional<double> otherwise = {}) {
  const double value = number_at(map, key, otherwise);
  if (!(value >= least && value <= max_runs) || value != std::floor(value))
    throw bad_input(map.find(key)->place, std::string(key) + " is " + number_text(value),
                    "give a whole number from " + number_text(least) + " to 100000");
  return static_cast<std::size_t>(value);
}

template <std::size_t n>
std::size_t word_of(const YamlNode& node, const char* key,
                    const std::array<std::string_view, n>& words) {
  const auto found = std::find(words.begin(), words.end(), std::string_view(node.text));
  if (node.kind != Kind::scalar || found == words.end())
    throw bad_input(node.place, std::string(key) + " is '" + node.text + "'",
                    suggestion(node.text, words));
  return static_cast<std::size_t>(found - words.begin());
}

bool flag_at(const YamlNode& map, const char* key) {
  const YamlNode* node = map.find(key);
  static constexpr std::array<std::string_view, 2> words = {"false", "true"};
  return node != nullptr && word_of(*node, key, words) == 1;
}

Interval interval_of(const YamlNode& node) {
  static constexpr std::array<std::string_view, 4> known = {"from", "to", "scale", "count"};
  static constexpr std::array<std::string_view, 2> scales = {"linear", "log"};
  check_keys(node, "vary", known);
  Interval interval{number_at(node, "from"), number_at(node, "to")};
  if (const YamlNode* scale = node.find("scale"))
    interval.logarithmic = word_of(*scale, "scale", scales) == 1;
  if (!(interval.from < interval.to))
    throw bad_input(node.place, "from is not below to", "give the smaller number first");
  if (interval.logarithmic && !(interval.from > 0))
    throw bad_input(node.place, "a logarithmic scale has no " + number_text(interval.from),
                    "give numbers above 0, or scale: linear");
  return interval;
}

VariedKey varied(const YamlKey& key, const YamlNode& node, bool random) {
  VariedKey out{key.name, {}, {}, key.place};
  if (steps_of(key.name).empty())
    throw bad_input(key.place, "'" + key.name + "' is no setting",
                    "write section.key, as in body.radius, or list[name].key");
  if (node.kind == Kind::map) {
    out.interval = interval_of(node);
    if (random) return out;
    const std::size_t count = count_at(node, "count", 2, {});
    for (std::size_t k = 0; k < count; ++k)
      out.values.push_back(
          out.interval->at(static_cast<double>(k) / static_cast<double>(count - 1)));
  } else if (node.kind == Kind::list) {
    for (const YamlNode& item : node.items) out.values.push_back(flow_text(item));
  } else if (node.kind == Kind::scalar) {
    out.values.push_back(flow_text(node));
  }
  if (out.values.empty())
    throw bad_input(node.place, "'" + key.name + "' has no values",
                    "list them, as in [5e3, 1e4], or give {from: 5e3, to: 2e4, count: 5}");
  return out;
}

Design design_of(const YamlNode& file) {
  const YamlNode* node = file.find("design");
  Design design;
  design.place = node != nullptr ? Place(node->place) : Place(file.place);
  if (node == nullptr) return design;
  if (node->kind != Kind::map) {
    design.kind = static_cast<DesignKind>(word_of(*node, "design", design_names));
  } else {
    static constexpr std::array<std::string_view, 3> known = {"kind", "samples", "seed"};
    check_keys(*node, "design", known);
    design.kind = static_cast<DesignKind>(
        word_of(needed(*node, "kind", "write kind: latin_hypercube"), "kind", design_names));
    if (node->find("samples") != nullptr) design.samples = count_at(*node, "samples", 1);
    design.seed = static_cast<std::int64_t>(count_at(*node, "seed", 0, 1));
  }
  if (design.is_random() != (design.samples > 0))
    throw bad_input(
        design.place,
        design.is_random() ? "a random design has no samples" : "only random designs have samples",
        design.is_random() ? "write design: {kind: latin_hypercube, samples: 100}"
                           : "leave them out, or choose latin_hypercube or sobol");
  return design;
}

bool is_metric(const std::string& name) {
  if (metric_index(name) < metrics_table().size()) return true;
  const auto of_runs = run_metrics_table();
  return std::any_of(of_runs.begin(), of_runs.end(),
                     [&](const RunMetric& one) { return one.name == name; });
}

AskedResult result_of(const YamlNode& node) {
  AskedResult result;
  result.place = node.place;
  if (node.kind == Kind::map) {
    static constexpr std::array<std::string_view, 3> known = {"name", "of", "time"};
    check_keys(node, "results", known);
    result.name = needed(node, "name", "write name: volume_error").text;
    if (const YamlNode* of = node.find("of"))
      result.of = static_cast<ResultOf>(word_of(*of, "of", result_words));
    if ((result.of == ResultOf::at) != (node.find("time") != nullptr))
      throw bad_input(node.place, "'of: at' and a time belong together",
                      "write {name: " + result.name + ", of: at, time: 0.5}");
    if (result.of == ResultOf::at) result.time = number_at(node, "time");
  } else {
    result.name = node.text;
    if (result.name.find(": ") != std::string::npos) result.of = ResultOf::largest;
  }
  if (result.name.find(": ") == std::string::npos && !is_metric(result.name)) {
    std::vector<std::string_view> names;
    for (const Metric& metric : metrics_table()) names.push_back(metric.name);
    for (const RunMetric& metric : run_metrics_table()) names.push_back(metric.name);
    throw bad_input(node.place, "there is no metric '" + result.name + "'",
                    suggestion(result.name, names) +
                        "; columns of supports and probes are named as \"grip: force_z\"");
  }
  return result;
}

std::vector<AskedResult> results_of(const YamlNode& node) {
  if (node.kind == Kind::scalar) return {result_of(node)};
  if (node.kind != Kind::list || node.items.empty())
    throw bad_input(node.place, "results are no list of names",
                    "list them, as in [volume_error, J_min]");
  std::vector<AskedResult> results;
  for (const YamlNode& one : node.items) results.push_back(result_of(one));
  return results;
}

/// A setting under two names would be varied by the one that comes later alone.
void refuse_rivals(const std::vector<VariedKey>& vary) {
  for (const VariedKey& one : vary)
    for (const VariedKey& other : vary)
      if (&one != &other && rival_of(one.path) == other.path)
        throw bad_input(one.place, one.path + " and " + other.path + " set the same",
                        "vary one of them");
}

std::vector<VariedKey> vary_of(const YamlNode& file, bool random) {
  const YamlNode& node =
      needed(file, "vary", "write vary: and below it body.radius: [0.01, 0.014]");
  if (node.kind != Kind::map || node.keys.empty())
    throw bad_input(node.place, "vary names no setting",
                    "write below it, as in material.young_modulus: [5e3, 1e4]");
  std::vector<VariedKey> vary;
  for (std::size_t k = 0; k < node.keys.size(); ++k)
    vary.push_back(varied(node.keys[k], node.items[k], random));
  refuse_rivals(vary);
  return vary;
}

std::vector<Override> fixed_of(const YamlNode& file) {
  std::vector<Override> fixed;
  const YamlNode* node = file.find("set");
  if (node != nullptr && node->kind != Kind::map)
    throw bad_input(node->place, "set is no mapping of settings to values",
                    "write below it, as in solver.duration: 0.5");
  for (std::size_t k = 0; node != nullptr && k < node->keys.size(); ++k)
    fixed.push_back(
        {node->keys[k].name, flow_text(node->items[k]), Place(node->keys[k].place).text()});
  return fixed;
}

void check_length(const SweepFile& study) {
  double runs = 1;
  for (const VariedKey& key : study.vary) {
    if (study.design.kind == DesignKind::grid) runs *= static_cast<double>(key.values.size());
    if (study.design.kind == DesignKind::list && key.values.size() != study.vary[0].values.size())
      throw bad_input(key.place,
                      "'" + key.path + "' has " + std::to_string(key.values.size()) +
                          " values, and '" + study.vary[0].path + "' " +
                          std::to_string(study.vary[0].values.size()),
                      "give as many of each: design list takes the k-th of all");
  }
  if (runs > max_runs)
    throw bad_input(study.design.place, "the grid has " + number_text(runs) + " runs",
                    "vary fewer settings, or choose {kind: latin_hypercube, samples: 200}");
}

}  // namespace

std::string Interval::at(double part) const {
  const double value = logarithmic ? from * std::pow(to / from, part) : from + part * (to - from);
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

std::string AskedResult::title() const {
  if (of == ResultOf::at) return name + ", at " + number_text(time) + " s";
  return of == ResultOf::worst
             ? name
             : name + ", " + std::string(result_words[static_cast<std::size_t>(of)]);
}

SweepFile read_sweep(const std::filesystem::path& path) {
  static constexpr std::array<std::string_view, 8> known = {"scene", "vary", "design",   "results",
                                                            "keep",  "set",  "pictures", "movie"};
  const YamlNode file = parse_yaml(read_text(path), path.string());
  if (file.kind != Kind::map)
    throw bad_input(Place{path.string()}, "this is no study",
                    "write scene: and vary: into it, or sinew new --study SCENE.yaml");
  if (file.find("vary") == nullptr && file.find("body") != nullptr)
    throw bad_input(file.place, "this is a scene, not a study",
                    "write one of it: sinew new --study " + shell_quoted(path.string()));
  check_keys(file, "", known);
  SweepFile study;
  study.path = path;
  const YamlNode& scene = needed(file, "scene", "write scene: scene.yaml");
  study.scene = scene.text;
  study.scene_place = scene.place;
  study.design = design_of(file);
  study.vary = vary_of(file, study.design.is_random());
  if (const YamlNode* results = file.find("results")) study.results = results_of(*results);
  if (study.results.empty())
    for (const char* name : {"volume_error", "J_min", "pose_error_rms"})
      study.results.push_back({name, ResultOf::worst, 0, file.place});
  if (const YamlNode* keep = file.find("keep"))
    study.keep = static_cast<KeptFrames>(word_of(*keep, "keep", kept_words));
  study.fixed = fixed_of(file);
  study.pictures = flag_at(file, "pictures"), study.movie = flag_at(file, "movie");
  check_length(study);
  return study;
}

std::vector<std::vector<std::string>> values_of(const SweepFile& study) {
  const std::vector<VariedKey>& vary = study.vary;
  std::vector<std::vector<std::string>> all;
  if (study.design.is_random()) {
    const auto samples =
        study.design.kind == DesignKind::sobol
            ? sobol(study.design.samples, vary.size(), study.design.seed)
            : latin_hypercube(study.design.samples, vary.size(), study.design.seed);
    for (const DesignPoint& sample : samples) {
      auto& values = all.emplace_back();
      for (std::size_t q = 0; q < vary.size(); ++q)
        values.push_back(vary[q].interval
                             ? vary[q].interval->at(sample[q])
                             : vary[q].values[static_cast<std::size_t>(
                                   sample[q] * static_cast<double>(vary[q].values.size()))]);
    }
    return all;
  }
  std::vector<std::size_t> lengths;
  for (const VariedKey& key : vary) lengths.push_back(key.values.size());
  std::vector<std::vector<std::size_t>> places;
  if (study.design.kind == DesignKind::grid)
    places = grid(lengths);
  else
    for (std::size_t k = 0; k < lengths[0]; ++k) places.emplace_back(lengths.size(), k);
  for (const auto& place : places) {
    auto& values = all.emplace_back();
    for (std::size_t q = 0; q < vary.size(); ++q) values.push_back(vary[q].values[place[q]]);
  }
  return all;
}

}  // namespace sinew
