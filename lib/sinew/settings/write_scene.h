// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes as text, with a comment for each key.
//
//     write_file(folder / "scene.yaml", resolved_scene(settings, folder));
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include <sinew/settings/row.h>
#include <sinew/settings/settings.h>
#include <sinew/settings/table.h>
#include <sinew/settings/values.h>

namespace sinew {

/// "  # [unit] help (permitted values)"
template <class Owner>
std::string comment_of(const Field<Owner>& row) {
  std::string text = "  # ";
  if (!row.unit.empty()) text += '[' + std::string(row.unit) + "] ";
  text += row.help;
  if (row.choices.size() > 1) text += " (" + values_text(rules_of(row)) + ')';
  return text;
}

/// "name: value", with the comment where `explained`.
template <class Owner>
std::string line_text(const Field<Owner>& row, const FieldValue& value, bool explained) {
  const std::string text = std::string(row.name) + ": " + scene_text(value, row.absent);
  return text + (explained ? comment_of(row) : "") + '\n';
}

/// The keys of a list's entry, indented by `indent` spaces.
template <class Owner>
std::string entry_text(std::span<const Field<Owner>> rows, const Owner& owner, std::size_t indent,
                       bool explained) {
  std::string text;
  for (const auto& row : rows) {
    text += std::string(indent, ' ') + (text.empty() ? "- " : "  ");
    text += line_text(row, row.get(owner), explained);
  }
  return text;
}

// The scene that a run writes beside its results.

/// Every setting, defaults included, as a scene with a line and a comment for each. Paths are
/// relative to `folder`, where the scene will be; read_scene() gives the same settings.
std::string resolved_scene(const Settings& settings, const std::filesystem::path& folder);

/// The same for the file `path`, which can be read again: what is written in its place. Throws bad
/// input where it would be too large.
std::string readable_scene(const Settings& settings, const std::filesystem::path& path);

}  // namespace sinew
