// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/settings/sections.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>

#include <sinew/core/text.h>
#include <sinew/settings/detail/entries.h>
#include <sinew/settings/text_file.h>
#include <sinew/settings/values.h>

namespace sinew {
namespace {

using Kind = YamlNode::Kind;

void read_limits(const YamlNode& bone, const std::string& path, Settings& settings) {
  const YamlNode* limits = bone.find("limits");
  if (limits == nullptr) return;
  const std::string below = path_below(path, "limits");
  settings.places[below] = limits->place;
  read_fields(*limits, below, limit_fields(), "", settings.bones.back().limits, settings.places);
}

void read_bone_list(const YamlNode& skeleton, Settings& settings) {
  const auto items = list_below(skeleton, "skeleton", "bones", settings.places);
  for (std::size_t i = 0; i < items.size(); ++i) {
    const std::string path = path_of_entry("skeleton", "bones", i);
    read_fields(items[i], path, bone_fields(), "limits", settings.bones.emplace_back(),
                settings.places);
    read_limits(items[i], path, settings);
  }
}

void read_keys(const YamlNode& track, const std::string& path, Settings& settings) {
  const auto items = list_below(track, path, "keys", settings.places);
  for (std::size_t i = 0; i < items.size(); ++i)
    read_key(items[i], path_of_entry(path, "keys", i), key_fields(),
             settings.tracks.back().keys.emplace_back(), settings);
}

void read_track_list(const YamlNode& motion, Settings& settings) {
  const auto items = list_below(motion, "motion", "tracks", settings.places);
  for (std::size_t i = 0; i < items.size(); ++i) {
    const std::string path = path_of_entry("motion", "tracks", i);
    read_fields(items[i], path, track_fields(), "keys", settings.tracks.emplace_back(),
                settings.places);
    read_keys(items[i], path, settings);
  }
}

void refuse_two(const Settings& settings, const std::string& file, const std::string& list) {
  throw bad_input(settings.place(file), file + " and " + list + " are both given",
                  "keep one of them");
}

bool is_yaml(const std::string& path) {
  std::string end = std::filesystem::path(path).extension().string();
  for (char& c : end) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return end == ".yaml" || end == ".yml";
}

/// The tree of the file that the scene names at `key`; its keys are `known`.
YamlNode read_file(const Settings& settings, const std::string& file, const std::string& key,
                   std::span<const std::string_view> known) {
  std::string text;
  try {
    text = read_text(file);
  } catch (const Error& error) {
    throw error.with_context(settings.place(key));
  }
  YamlNode tree = parse_yaml(text, file);
  if (!tree.place.file) tree.place = Place{file};
  if (tree.kind == Kind::empty)
    throw bad_input({file}, "there is nothing in this file", "write its " + listed(known));
  check_keys(tree, "", known);
  return tree;
}

void read_frame_rate(const YamlNode& clip, Settings& settings) {
  const YamlNode* given = clip.find("frame_rate");
  if (given == nullptr || settings.motion.frame_rate) return;
  for (const auto& row : settings_table())
    if (row.section == "motion" && row.name == "frame_rate") {
      row.set(settings, read_value(*given, "frame_rate", rules_of(row)));
      settings.places["motion.frame_rate"] = given->place;
    }
}

}  // namespace

void read_bones(const YamlNode& skeleton, Settings& settings) {
  if (settings.skeleton.file.empty()) return read_bone_list(skeleton, settings);
  if (skeleton.find("bones") != nullptr) refuse_two(settings, "skeleton.file", "skeleton.bones");
}

void read_tracks(const YamlNode& motion, Settings& settings) {
  const YamlNode* tracks = motion.find("tracks");
  if (tracks == nullptr || (tracks->kind != Kind::scalar && tracks->items.empty()))
    return;  // at rest
  if (!settings.motion.file.empty()) refuse_two(settings, "motion.file", "motion.tracks");
  read_track_list(motion, settings);
}

void read_bound(const YamlNode& binding, Settings& settings) {
  const YamlNode* list = binding.find("explicit");
  if (list == nullptr || (list->kind != Kind::scalar && list->items.empty())) return;
  const auto items = list_below(binding, "binding", "explicit", settings.places);
  for (std::size_t i = 0; i < items.size(); ++i)
    read_fields(items[i], path_of_entry("binding", "explicit", i), bound_fields(), "",
                settings.bound.emplace_back(), settings.places);
}

void read_rig_files(Settings& settings) {
  static constexpr std::array<std::string_view, 1> of_rig = {"bones"};
  static constexpr std::array<std::string_view, 2> of_clip = {"tracks", "frame_rate"};
  if (is_yaml(settings.skeleton.file)) {
    read_bone_list(read_file(settings, settings.skeleton.file, "skeleton.file", of_rig), settings);
    settings.skeleton.file.clear();
  }
  if (is_yaml(settings.motion.file)) {
    const YamlNode clip = read_file(settings, settings.motion.file, "motion.file", of_clip);
    read_frame_rate(clip, settings);
    read_track_list(clip, settings);
    settings.motion.file.clear();
  }
}

std::optional<Settings> read_rig_alone(const std::filesystem::path& path) {
  const YamlNode tree = parse_yaml(read_text(path), path.string());
  Settings settings;
  settings.places[""] = {path.string()};
  if (tree.find("body") != nullptr) return std::nullopt;
  if (tree.find("bones") != nullptr)
    settings.skeleton.file = path.string();
  else if (tree.find("tracks") != nullptr)
    settings.motion.file = path.string();
  else
    return std::nullopt;
  read_rig_files(settings);
  return settings;
}

}  // namespace sinew
