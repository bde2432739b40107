// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/settings/read_scene.h>

#include <array>

#include <sinew/core/text.h>
#include <sinew/settings/sections.h>
#include <sinew/settings/table.h>
#include <sinew/settings/text_file.h>
#include <sinew/settings/values.h>

namespace sinew {

namespace {

using Kind = YamlNode::Kind;

/// A key that has a new name; scenes may use the old one.
struct RenamedKey {
  std::string_view section, before, now;
};
constexpr std::array<RenamedKey, 1> renamed_keys = {{{"hierarchy", "least", "min_particles"}}};

std::string warning_of(const Place& place, const RenamedKey& key) {
  const std::string section = std::string(key.section) + '.';
  return place.text() + ": " + section + std::string(key.before) + " is now called " + section +
         std::string(key.now) + "; write that, since the old name may go";
}

/// How the key of a path was renamed, or nullptr.
const RenamedKey* renamed(const std::string& path) {
  for (const RenamedKey& key : renamed_keys)
    if (path == std::string(key.section) + '.' + std::string(key.before)) return &key;
  return nullptr;
}

/// Gives the keys of a scene their new names.
void rename_keys(YamlNode& scene, std::vector<std::string>& warnings) {
  for (const RenamedKey& renamed : renamed_keys)
    for (std::size_t s = 0; s < scene.keys.size(); ++s) {
      if (scene.keys[s].name != renamed.section) continue;
      YamlNode& section = scene.items[s];
      for (YamlKey& key : section.keys) {
        if (key.name != renamed.before) continue;
        if (section.find(renamed.now) != nullptr)
          throw bad_input(key.place,
                          "'" + key.name + "' is the old name of '" + std::string(renamed.now) +
                              "', which the section has as well",
                          "remove one of them");
        warnings.push_back(warning_of(key.place, renamed));
        key.name = renamed.now;
      }
    }
}

}  // namespace

namespace {

std::vector<Field<Settings>> rows_of(std::string_view section) {
  std::vector<Field<Settings>> rows;
  for (const auto& row : settings_table())
    if (row.section == section) rows.push_back(row);
  return rows;
}

/// The keys of a section that hold lists.
std::span<const std::string_view> lists_of(std::string_view section) {
  static constexpr std::array<std::string_view, 3> lists = {"bones", "tracks", "explicit"};
  if (section == "skeleton") return std::span(lists).first(1);
  if (section == "motion") return std::span(lists).subspan(1, 1);
  if (section == "binding") return std::span(lists).last(1);
  if (section == "world") return world_lists;
  return {};
}

/// A missing section has all its defaults; it is an error where keys are required.
YamlNode section_of(const YamlNode& scene, std::string_view name, Settings& settings) {
  YamlNode section;
  section.place = settings.place("");
  for (std::size_t i = 0; i < scene.keys.size(); ++i) {
    if (scene.keys[i].name != name) continue;
    section = scene.items[i];
    if (section.kind != Kind::scalar) section.place = scene.keys[i].place;
    settings.places[std::string(name)] = scene.keys[i].place;
  }
  return section;
}

constexpr std::string_view list_of_bodies = "bodies";

/// Further bodies, if the scene has any.
void read_bodies(const YamlNode& scene, Settings& settings) {
  if (scene.find(list_of_bodies) == nullptr) return;
  const auto items = list_below(scene, "", list_of_bodies, settings.places);
  for (std::size_t i = 0; i < items.size(); ++i)
    read_fields(items[i], path_of_entry("", list_of_bodies, i), part_fields(), "",
                settings.bodies.emplace_back(), settings.places);
}

/// Without bones a body hangs in its testing machine, flies, or falls on obstacles.
bool needs_bones(const YamlNode& scene, const YamlNode& skeleton, const Settings& settings) {
  const YamlNode* world = scene.find("world");
  const bool is_alone = settings.supports.empty() && settings.loads.empty() &&
                        (world == nullptr || world->items.empty()) && !settings.moves_initially();
  return is_alone || skeleton.find("bones") != nullptr || !settings.skeleton.file.empty();
}

Settings read_settings(const YamlNode& scene, const std::string& file,
                       std::span<const std::string_view> known) {
  Settings settings;
  settings.places[""] = {file};
  if (scene.kind == Kind::empty)
    throw bad_input({file}, "there is no scene in this file",
                    "write its sections: " + listed(known));
  std::vector<std::string_view> keys(known.begin(), known.end());
  keys.push_back(list_of_bodies);
  keys.insert(keys.end(), machine_lists.begin(), machine_lists.end());
  check_keys(scene, "", keys);
  read_bodies(scene, settings);
  read_machine(scene, settings);
  for (const std::string_view name : known) {
    const YamlNode section = section_of(scene, name, settings);
    const auto rows = rows_of(name);
    read_fields<Settings>(section, std::string(name), rows, lists_of(name), settings,
                          settings.places);
    if (name == "skeleton" && needs_bones(scene, section, settings)) read_bones(section, settings);
    if (name == "motion") read_tracks(section, settings);
    if (name == "world") read_world(section, settings);
    if (name == "binding") read_bound(section, settings);
  }
  check_names_of_machine(settings);
  return settings;
}

}  // namespace

std::string present_path(const std::string& path) {
  const RenamedKey* key = renamed(path);
  return key != nullptr ? std::string(key->section) + '.' + std::string(key->now) : path;
}

Settings scene_from_text(const std::string& text, const std::string& name,
                         const std::filesystem::path& folder, std::span<const Override> overrides) {
  YamlNode scene = parse_yaml(text, name);
  std::vector<std::string> warnings;
  rename_keys(scene, warnings);
  for (Override given : overrides) {
    if (const RenamedKey* key = renamed(given.path)) {
      warnings.push_back(warning_of({given.given}, *key));
      given.path = present_path(given.path);
    }
    apply_override(given, scene);
  }
  Settings settings = read_settings(scene, name, sections());
  settings.warnings = std::move(warnings);
  apply_preset(settings);
  check_together(settings);
  open_paths_from_here(settings, folder);
  read_rig_files(settings);
  return settings;
}

Settings read_scene(const std::filesystem::path& path, std::span<const Override> overrides) {
  return scene_from_text(read_text(path), path.string(), path.parent_path(), overrides);
}

Settings settings_of_mesh(const std::filesystem::path& mesh, std::span<const Override> overrides) {
  static constexpr std::array<std::string_view, 2> known = {"body", "material"};
  const Place place = {mesh.string()};
  const YamlNode path = {Kind::scalar, true, place, mesh.string(), {}, {}};
  const YamlNode body = {Kind::map, false, place, "", {path}, {{"mesh", place}}};
  YamlNode scene = {Kind::map, false, place, "", {body}, {{"body", place}}};
  for (const Override& given : overrides) apply_override(given, scene);
  Settings settings = read_settings(scene, place.file, known);
  apply_preset(settings);
  check_together(settings);
  return settings;
}

}  // namespace sinew
