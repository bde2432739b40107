// SPDX-License-Identifier: GPL-3.0-or-later
// Values of a scene, checked against their rows in the table of settings.
//
//     const FieldValue value = read_value(node, "body.radius", rules_of(row));
//     read_fields(node, "body", rows, "", owner, places);
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/settings/table.h>
#include <sinew/settings/yaml_tree.h>

namespace sinew {

/// What a row of the table requires of its value, for any owner.
struct Rules {
  FieldKind kind;
  std::string_view unit;
  Range range;
  std::span<const std::string_view> choices;
  std::string_view absent;
  std::size_t count = 0;  ///< count of a list of numbers
};

template <class Owner>
Rules rules_of(const Field<Owner>& row) {
  return {row.kind, row.unit, row.range, row.choices, row.absent, row.count};
}

/// "a number > 0 (m), or auto": the permitted values.
std::string values_text(const Rules& rules);

/// The value of `node`, or monostate for the absent word. Throws bad input, with the value's place
/// and `path` ("body.radius"), for another type, a number out of range or not finite, an unknown
/// choice, an empty text.
FieldValue read_value(const YamlNode& node, const std::string& path, const Rules& rules);

/// A decimal number or a fraction such as 1/30; nothing when the text is neither. Infinite or not a
/// number where the text is that, is too large for a double, or divides by zero.
std::optional<double> parse_number(std::string_view text);

// Reads the keys of one mapping into an owner, by the rows of the table of settings.

using Places = std::map<std::string, Place, std::less<>>;

/// A place takes ten times the memory of its value: those of list entries beyond are not kept.
inline constexpr std::size_t max_places = 100'000;

/// The path of a key below `path`: "body" and "mesh" give "body.mesh".
std::string path_below(const std::string& path, std::string_view key);
/// The path of an entry of a list: "skeleton.bones[2]".
std::string path_of_entry(const std::string& path, std::string_view list, std::size_t index);

/// Throws bad input unless `node` is a mapping (or empty) and each of its keys is `known`; the cure
/// is the nearest known key, or the section to which the key belongs.
void check_keys(const YamlNode& node, const std::string& path,
                std::span<const std::string_view> known);

/// The items of the list at `key`. Throws bad input when it is missing, empty or no list. Records
/// the places of the list and its entries.
std::span<const YamlNode> list_below(const YamlNode& node, const std::string& path,
                                     std::string_view key, Places& places);

/// "PATH is missing; add KEY: VALUES"
Error missing_key(const YamlNode& node, const std::string& path, const Rules& rules);

/// Sets the members of `owner` that `rows` describe; other keys are ignored.
template <class Owner>
void read_rows(const YamlNode& node, const std::string& path, std::span<const Field<Owner>> rows,
               Owner& owner, Places& places) {
  for (const auto& row : rows) {
    const std::string below = path_below(path, row.name);
    const YamlNode* value = node.find(row.name);
    if (value == nullptr && row.required) throw missing_key(node, below, rules_of(row));
    if (value == nullptr) continue;
    row.set(owner, read_value(*value, below, rules_of(row)));
    places[below] = value->place;
  }
}

/// The same, but only the rows' keys and `own`, keys of lists in the same mapping, are allowed.
template <class Owner>
void read_fields(const YamlNode& node, const std::string& path, std::span<const Field<Owner>> rows,
                 std::span<const std::string_view> own, Owner& owner, Places& places) {
  std::vector<std::string_view> known;
  for (const auto& row : rows) known.push_back(row.name);
  known.insert(known.end(), own.begin(), own.end());
  check_keys(node, path, known);
  read_rows(node, path, rows, owner, places);
}

/// With one such list, or none: "".
template <class Owner>
void read_fields(const YamlNode& node, const std::string& path, std::span<const Field<Owner>> rows,
                 std::string_view own, Owner& owner, Places& places) {
  const std::array<std::string_view, 1> list = {own};
  read_fields(node, path, rows, std::span(list).first(own.empty() ? 0 : 1), owner, places);
}

}  // namespace sinew
