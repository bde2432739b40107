// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/settings/write_scene.h>

#include <sinew/core/error.h>
#include <sinew/settings/read_scene.h>
#include <sinew/settings/sections.h>
#include <sinew/settings/text_file.h>

namespace sinew {
namespace {

std::string bones_text(const Settings& settings) {
  if (settings.bones.empty()) return "";  // they are in skeleton.file
  std::string text = "  bones:\n";
  for (const BoneDefinition& bone : settings.bones) {
    const bool first = &bone == &settings.bones.front();
    text += entry_text(bone_fields(), bone, 4, first) + "      limits:\n";
    for (const auto& row : limit_fields())
      text += "        " + line_text(row, row.get(bone.limits), first);
  }
  return text;
}

std::string tracks_text(const Settings& settings) {
  if (settings.tracks.empty()) return "  tracks: []\n";
  std::string text = "  tracks:\n";
  for (const TrackDefinition& track : settings.tracks) {
    const bool first = &track == &settings.tracks.front();
    text += entry_text(track_fields(), track, 4, first) + "      keys:\n";
    for (const KeyDefinition& key : track.keys)
      text += entry_text(key_fields(), key, 8, first && &key == &track.keys.front());
  }
  return text;
}

std::string bound_text(const Settings& settings) {
  if (settings.bound.empty()) return "";
  std::string text = "  explicit:\n";
  for (const BoundSettings& bound : settings.bound)
    text += entry_text(bound_fields(), bound, 4, &bound == &settings.bound.front());
  return text;
}

std::string bodies_text(const Settings& settings, const std::filesystem::path& folder) {
  if (settings.bodies.empty()) return "";
  std::string text = "\nbodies:\n";
  for (PartOptions part : settings.bodies) {
    part.body.mesh = path_in(folder, part.body.mesh);
    text += entry_text(part_fields(), part, 2, text.ends_with(":\n"));
  }
  return text;
}

/// Whether a key with a default must be left out because the other key of its pair is given.
bool is_replaced(const Settings& settings, const Field<Settings>& row) {
  const std::string name = std::string(row.section) + '.' + std::string(row.name);
  for (const auto& other : settings_table())
    if (row.absent.empty() &&
        std::string(other.section) + '.' + std::string(other.name) == rival_of(name))
      return !std::holds_alternative<std::monostate>(other.get(settings));
  return false;
}

/// Paths relative to `folder`, where the scene will be.
FieldValue value_in(const std::filesystem::path& folder, const Settings& settings,
                    const Field<Settings>& row) {
  FieldValue value = row.get(settings);
  const auto* text = std::get_if<std::string>(&value);
  if (row.kind != FieldKind::path || text == nullptr) return value;
  return path_in(folder, *text);
}

std::string section_text(const Settings& settings, std::string_view section,
                         const std::filesystem::path& folder) {
  std::string text;
  for (const auto& row : settings_table()) {
    if (row.section != section || is_replaced(settings, row)) continue;
    text += "  " + line_text(row, value_in(folder, settings, row), true);
  }
  return text;
}

}  // namespace

std::string resolved_scene(const Settings& settings, const std::filesystem::path& folder) {
  std::string text = "# Every setting of this run. SI units, angles in degrees.\n";
  for (const std::string_view section : sections()) {
    text += '\n' + std::string(section) + ":\n" + section_text(settings, section, folder);
    if (section == "body") text += bodies_text(settings, folder);
    if (section == "skeleton") text += bones_text(settings);
    if (section == "motion") text += tracks_text(settings);
    if (section == "world") text += world_text(settings, folder) + machine_text(settings, folder);
    if (section == "binding") text += bound_text(settings);
  }
  return text;
}

std::string readable_scene(const Settings& settings, const std::filesystem::path& path) {
  // Longer ones are not tried, which takes 25 times their bytes: only their length tells them
  // apart.
  constexpr std::size_t tried = std::size_t{8} << 20;  // bytes
  std::string text = resolved_scene(settings, path.parent_path());
  const auto refused = [](const std::string& why) {
    return bad_input(
        "the scene, with all its values written out, could not be read again (" + why + ")",
        "give it fewer bones or keys");
  };
  if (text.size() > longest_scene)
    throw refused(std::to_string(text.size()) + " bytes, over " + std::to_string(longest_scene));
  if (text.size() > tried) return text;
  try {
    scene_from_text(text, path.string(), path.parent_path());
  } catch (const Error& error) {
    throw refused(error.what());
  }
  return text;
}

}  // namespace sinew
