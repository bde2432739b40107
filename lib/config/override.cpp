// SPDX-License-Identifier: GPL-3.0-or-later
#include "config/override.h"

#include "config/checks.h"
#include "core/words.h"

namespace sinew {
namespace {

using Kind = YamlNode::Kind;

/// The value below `key`, which is put into the mapping when it lacks it.
YamlNode& child(YamlNode& map, const std::string& key, const Place& place) {
  for (std::size_t i = 0; i < map.keys.size(); ++i)
    if (map.keys[i].name == key) return map.items[i];
  map.keys.push_back({key, place});
  map.items.push_back({Kind::empty, place, "", false, {}, {}});
  return map.items.back();
}

void remove(YamlNode& scene, std::string_view path) {
  const auto dot = path.find('.');
  for (std::size_t s = 0; s < scene.keys.size(); ++s) {
    if (scene.keys[s].name != path.substr(0, dot)) continue;
    YamlNode& section = scene.items[s];
    for (std::size_t i = section.keys.size(); i-- > 0;) {
      if (section.keys[i].name != path.substr(dot + 1)) continue;
      section.keys.erase(section.keys.begin() + static_cast<std::ptrdiff_t>(i));
      section.items.erase(section.items.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
}

/// Whether the text takes its key back, as in body.count=auto; all rivals have this word for it.
bool is_absent_word(const YamlNode& value) { return !value.quoted && value.text == "auto"; }

void place_all(YamlNode& node, const Place& place) {
  node.place = place;
  for (YamlKey& key : node.keys) key.place = place;
  for (YamlNode& item : node.items) place_all(item, place);
}

}  // namespace

Override parse_override(const std::string& text) {
  const auto equals = text.find('=');
  const std::string path = text.substr(0, equals);
  const auto dot = path.find('.');
  if (equals == text.npos || dot == path.npos || dot == 0 || dot + 1 == path.size())
    throw bad_input("--set " + shown(text) + " is no setting",
                    "write --set section.key=value, as in --set body.radius=0.01");
  return {path, text.substr(equals + 1), "--set " + text};
}

void apply_override(const Override& given, YamlNode& scene) {
  const Place place = {given.given};
  YamlNode value = parse_yaml(given.value, place.file);
  place_all(value, place);
  if (scene.kind != Kind::map) return;
  const auto dot = given.path.find('.');
  YamlNode& section = child(scene, given.path.substr(0, dot), place);
  if (section.kind == Kind::empty) section.kind = Kind::map;
  if (section.kind != Kind::map) return;
  if (!is_absent_word(value)) remove(scene, rival_of(given.path));
  child(section, given.path.substr(dot + 1), place) = std::move(value);
}

}  // namespace sinew
