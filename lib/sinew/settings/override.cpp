// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/settings/override.h>

#include <algorithm>
#include <charconv>

#include <sinew/core/text.h>
#include <sinew/settings/sections.h>

namespace sinew {
namespace {

using Kind = YamlNode::Kind;

/// The value of `key`, added to the mapping when missing.
YamlNode& child(YamlNode& map, const std::string& key, const Place& place) {
  for (std::size_t i = 0; i < map.keys.size(); ++i)
    if (map.keys[i].name == key) return map.items[i];
  map.keys.push_back({key, place});
  map.items.push_back({Kind::empty, false, place, "", {}, {}});
  return map.items.back();
}

void remove(YamlNode& map, std::string_view key) {
  for (std::size_t i = map.keys.size(); i-- > 0;) {
    if (map.keys[i].name != key) continue;
    map.keys.erase(map.keys.begin() + static_cast<std::ptrdiff_t>(i));
    map.items.erase(map.items.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

/// Whether the text unsets its key, as in body.count=auto; all paired keys use this word.
bool is_absent_word(const YamlNode& value) { return !value.quoted && value.text == "auto"; }

void place_all(YamlNode& node, const Place& place) {
  node.place = place;
  for (YamlKey& key : node.keys) key.place = place;
  for (YamlNode& item : node.items) place_all(item, place);
}

/// The name of a list's entry; of tracks, that of the bone. "" for none.
std::string name_of(const YamlNode& entry) {
  for (const char* key : {"name", "bone"})
    if (const YamlNode* name = entry.find(key)) return name->text;
  return "";
}

/// "tip, base", or "0 to 3" of entries without names.
std::string entries_of(const YamlNode& list) {
  std::string names;
  for (const YamlNode& entry : list.items)
    if (const std::string name = name_of(entry); !name.empty())
      names += (names.empty() ? "" : ", ") + name;
  return names.empty() ? "0 to " + std::to_string(list.items.size() - 1) : names;
}

/// The entry of that name, or else at that place, counted from 0. Throws bad input.
YamlNode& entry_of(YamlNode& list, const PathStep& step, const Place& place) {
  if (list.kind != Kind::list || list.items.empty())
    throw bad_input(place, "the scene has no list '" + step.key + "'",
                    "write its entries into the scene");
  for (YamlNode& entry : list.items)
    if (name_of(entry) == step.entry) return entry;
  std::size_t index = 0;
  const char *begin = step.entry.data(), *end = begin + step.entry.size();
  const auto [stop, error] = std::from_chars(begin, end, index);
  if (error == std::errc() && stop == end && index < list.items.size()) return list.items[index];
  throw bad_input(place, "'" + step.key + "' has no entry '" + step.entry + "'",
                  "choose from " + entries_of(list));
}

/// The mapping that a step leads to, which may be new; nullptr where there is a scalar.
YamlNode* follow(YamlNode& map, const PathStep& step, const Place& place) {
  YamlNode* below = &child(map, step.key, place);
  if (!step.entry.empty()) below = &entry_of(*below, step, place);
  if (below->kind == Kind::empty) below->kind = Kind::map;
  if (below->kind == Kind::list && !below->items.empty())
    throw bad_input(place, "'" + step.key + "' is a list",
                    "name one of its entries, as " + step.key + "[...]: " + entries_of(*below));
  return below->kind == Kind::map ? below : nullptr;
}

/// The place of the first one that is not within brackets, in which names may have any.
std::size_t find_outside(const std::string& text, char what, std::size_t from = 0) {
  int depth = 0;
  for (std::size_t i = from; i < text.size(); ++i) {
    if (text[i] == '[') ++depth;
    if (text[i] == ']') --depth;
    if (text[i] == what && depth == 0) return i;
  }
  return text.npos;
}

}  // namespace

std::vector<PathStep> steps_of(const std::string& path) {
  std::vector<PathStep> steps;
  for (std::size_t from = 0; from <= path.size();) {
    const std::size_t dot = std::min(find_outside(path, '.', from), path.size());
    PathStep step{path.substr(from, dot - from), ""};
    if (const auto open = step.key.find('['); open != step.key.npos) {
      if (step.key.back() != ']' || open + 2 >= step.key.size()) return {};
      step.entry = step.key.substr(open + 1, step.key.size() - open - 2);
      step.key.resize(open);
    }
    if (step.key.empty()) return {};
    steps.push_back(std::move(step));
    from = dot + 1;
  }
  const bool whole = steps.size() > 1 && steps.back().entry.empty();
  return whole ? steps : std::vector<PathStep>();
}

std::string canonical_path(const std::string& path, const YamlNode& scene) {
  std::string canonical;
  const YamlNode* at = &scene;
  for (const PathStep& step : steps_of(path)) {
    canonical += (canonical.empty() ? "" : ".") + step.key;
    at = at != nullptr ? at->find(step.key) : nullptr;
    if (step.entry.empty()) continue;
    std::string place = step.entry;
    for (std::size_t k = 0; at != nullptr && k < at->items.size(); ++k)
      if (name_of(at->items[k]) == step.entry) place = std::to_string(k);
    canonical += '[' + place + ']';
    at = nullptr;  // lists of lists are by names alone
  }
  return canonical;
}

Override parse_override(const std::string& text) {
  const std::size_t equals = find_outside(text, '=');
  const std::string path = text.substr(0, equals);
  if (equals == text.npos || steps_of(path).empty())
    throw bad_input("--set " + shown(text) + " is no setting",
                    "write --set section.key=value, as in --set body.radius=0.01");
  return {path, text.substr(equals + 1), "--set " + text};
}

void apply_override(const Override& given, YamlNode& scene) {
  const Place place = {given.given};
  YamlNode value = parse_yaml(given.value, place.file);
  place_all(value, place);
  if (scene.kind != Kind::map) return;
  const std::vector<PathStep> steps = steps_of(given.path);
  if (steps.empty())
    throw bad_input(place, "'" + given.path + "' is no setting",
                    "write section.key, as in body.radius, or list[name].key");
  YamlNode* map = &scene;
  for (std::size_t k = 0; k + 1 < steps.size() && map != nullptr; ++k)
    map = follow(*map, steps[k], place);
  if (map == nullptr) return;
  const std::string& key = steps.back().key;
  const std::string_view rival = rival_of(given.path);
  if (!rival.empty() && !is_absent_word(value)) remove(*map, rival.substr(rival.find('.') + 1));
  child(*map, key, place) = std::move(value);
}

}  // namespace sinew
