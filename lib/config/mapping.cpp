// SPDX-License-Identifier: GPL-3.0-or-later
#include "config/mapping.h"

#include <algorithm>

#include "core/words.h"

namespace sinew {
namespace {

using Kind = YamlNode::Kind;

/// Every place in a scene where the table knows a key of this name.
std::vector<std::string> homes_of(std::string_view name) {
  std::vector<std::string> homes;
  const auto look = [&](const auto& rows, const std::string& path) {
    for (const auto& row : rows)
      if (row.name == name) homes.push_back(path.empty() ? std::string(row.section) : path);
  };
  look(settings_table(), "");
  look(bone_fields(), "skeleton.bones");
  look(limit_fields(), "skeleton.bones[].limits");
  look(bound_fields(), "binding.explicit");
  look(track_fields(), "motion.tracks");
  look(key_fields(), "motion.tracks[].keys");
  look(obstacle_fields(), "world.obstacles");
  look(pin_fields(), "world.pins");
  look(field_fields(), "world.fields");
  look(strength_fields(), "world.fields[].keys");
  look(muscle_fields(), "world.muscles");
  look(activation_fields(), "world.muscles[].keys");
  return homes;
}

std::string cure_for(std::string_view key, std::span<const std::string_view> known) {
  const auto homes = homes_of(key);
  const bool misplaced = nearest(key, known).empty() && !homes.empty();
  if (misplaced) return "it belongs into " + homes.front() + ", check the indentation";
  return suggestion(key, known);
}

}  // namespace

std::string path_below(const std::string& path, std::string_view key) {
  return path.empty() ? std::string(key) : path + '.' + std::string(key);
}

void check_keys(const YamlNode& node, const std::string& path,
                std::span<const std::string_view> known) {
  const std::string name = path.empty() ? "a scene" : path;
  if (node.kind != Kind::map && node.kind != Kind::empty)
    throw bad_input(node.place, name + " must be a group of keys",
                    "write its keys below it, one 'key: value' a line: " + listed(known));
  for (const YamlKey& key : node.keys)
    if (std::find(known.begin(), known.end(), key.name) == known.end())
      throw bad_input(key.place, "unknown key " + shown(key.name) + " in " + name,
                      cure_for(key.name, known));
}

std::span<const YamlNode> list_below(const YamlNode& node, const std::string& path,
                                     std::string_view key, Places& places) {
  const std::string below = path_below(path, key);
  const YamlNode* list = node.find(key);
  const std::string cure = "write its entries below it, each beginning with '- '";
  if (list == nullptr)
    throw bad_input(node.place, below + " is missing", "add " + std::string(key) + ": and " + cure);
  if (list->kind != Kind::list) throw bad_input(list->place, below + " must be a list", cure);
  if (list->items.empty()) throw bad_input(list->place, below + " has no entries", cure);
  places[below] = list->place;
  for (std::size_t i = 0; i < list->items.size(); ++i)
    places[below + '[' + std::to_string(i) + ']'] = list->items[i].place;
  return list->items;
}

Error missing_key(const YamlNode& node, const std::string& path, const Rules& rules) {
  const std::string key = path.substr(path.rfind('.') + 1);
  return bad_input(node.place, path + " is missing", "add " + key + ": with " + values_text(rules));
}

}  // namespace sinew
