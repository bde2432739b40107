// SPDX-License-Identifier: GPL-3.0-or-later
#include "config/resolved.h"

#include "config/checks.h"
#include "config/paths.h"
#include "config/values.h"
#include "core/scene_text.h"
#include "core/settings_table.h"

namespace sinew {
namespace {

template <class Owner>
std::string comment(const Field<Owner>& row) {
  std::string text = "  # ";
  if (!row.unit.empty()) text += '[' + std::string(row.unit) + "] ";
  text += row.help;
  if (row.choices.size() > 1) text += " (" + values_text(rules_of(row)) + ')';
  return text;
}

template <class Owner>
std::string line(const Field<Owner>& row, const FieldValue& value, bool explained) {
  const std::string text = std::string(row.name) + ": " + scene_text(value, row.absent);
  return text + (explained ? comment(row) : "") + '\n';
}

/// The keys of a list's entry; the first entry explains them.
template <class Owner>
std::string entry(std::span<const Field<Owner>> rows, const Owner& owner, std::size_t indent,
                  bool explained) {
  std::string text;
  for (const auto& row : rows) {
    text += std::string(indent, ' ') + (text.empty() ? "- " : "  ");
    text += line(row, row.get(owner), explained);
  }
  return text;
}

std::string bones_text(const Settings& settings) {
  if (settings.bones.empty()) return "";  // they stand in skeleton.file
  std::string text = "  bones:\n";
  for (const BoneSettings& bone : settings.bones) {
    const bool first = &bone == &settings.bones.front();
    text += entry(bone_fields(), bone, 4, first) + "      limits:\n";
    for (const auto& row : limit_fields())
      text += "        " + line(row, row.get(bone.limits), first);
  }
  return text;
}

std::string tracks_text(const Settings& settings) {
  if (settings.tracks.empty()) return "  tracks: []\n";
  std::string text = "  tracks:\n";
  for (const TrackSettings& track : settings.tracks) {
    const bool first = &track == &settings.tracks.front();
    text += entry(track_fields(), track, 4, first) + "      keys:\n";
    for (const KeySettings& key : track.keys)
      text += entry(key_fields(), key, 8, first && &key == &track.keys.front());
  }
  return text;
}

std::string bound_text(const Settings& settings) {
  if (settings.bound.empty()) return "";
  std::string text = "  explicit:\n";
  for (const BoundSettings& bound : settings.bound)
    text += entry(bound_fields(), bound, 4, &bound == &settings.bound.front());
  return text;
}

/// Whether a key with a default must stay out because its rival is given.
bool is_replaced(const Settings& settings, const Field<Settings>& row) {
  const std::string name = std::string(row.section) + '.' + std::string(row.name);
  for (const auto& other : settings_table())
    if (row.absent.empty() &&
        std::string(other.section) + '.' + std::string(other.name) == rival_of(name))
      return !std::holds_alternative<std::monostate>(other.get(settings));
  return false;
}

/// Relative paths as the scene in `folder` sees them.
FieldValue value_in(const std::filesystem::path& folder, const Settings& settings,
                    const Field<Settings>& row) {
  const FieldValue value = row.get(settings);
  const auto* text = std::get_if<std::string>(&value);
  if (row.kind != FieldKind::path || text == nullptr) return value;
  const std::filesystem::path path = *text;
  return path.is_absolute() ? value : seen_from(folder, path).string();
}

std::string section_text(const Settings& settings, std::string_view section,
                         const std::filesystem::path& folder) {
  std::string text;
  for (const auto& row : settings_table()) {
    if (row.section != section || is_replaced(settings, row)) continue;
    text += "  " + line(row, value_in(folder, settings, row), true);
  }
  return text;
}

}  // namespace

std::string resolved_scene(const Settings& settings, const std::filesystem::path& folder) {
  std::string text = "# Every setting of this run. SI units, angles in degrees.\n";
  for (const std::string_view section : sections()) {
    text += '\n' + std::string(section) + ":\n" + section_text(settings, section, folder);
    if (section == "skeleton") text += bones_text(settings);
    if (section == "motion") text += tracks_text(settings);
    if (section == "binding") text += bound_text(settings);
  }
  return text;
}

}  // namespace sinew
