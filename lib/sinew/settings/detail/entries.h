// SPDX-License-Identifier: GPL-3.0-or-later
// Lists of a scene whose entries may have lists of keys: read and written.
//
//     read_entries(node, "world", "pins", world.pins, settings.places, read_one);
//     text += list_text("pins", world.pins, 2, entry_text_of_one);
#pragma once

#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/settings/settings.h>
#include <sinew/settings/values.h>
#include <sinew/settings/write_scene.h>

namespace sinew {

inline bool has_entries(const YamlNode& node, std::string_view list) {
  const YamlNode* found = node.find(list);
  return found != nullptr && (found->kind == YamlNode::Kind::scalar || !found->items.empty());
}

/// Calls read(item, path, entry) for the entries of a list that may be missing or empty.
template <class Owner, class Read>
void read_entries(const YamlNode& node, const std::string& path, std::string_view list,
                  std::vector<Owner>& owners, Places& places, const Read& read) {
  if (!has_entries(node, list)) return;
  const auto items = list_below(node, path, list, places);
  for (std::size_t i = 0; i < items.size(); ++i)
    read(items[i], path_of_entry(path, list, i), owners.emplace_back());
}

/// Reads a key of an entry. In scenes of many, an error names a place around that of its value.
template <class Key>
void read_key(const YamlNode& item, const std::string& path, std::span<const Field<Key>> rows,
              Key& key, Settings& settings) {
  Places forgotten;
  read_fields(item, path, rows, "", key,
              settings.places.size() < max_places ? settings.places : forgotten);
}

/// Keys of an entry, in its list `list`, with ascending times.
template <class Key>
void read_keys(const YamlNode& node, const std::string& path, std::span<const Field<Key>> rows,
               std::vector<Key>& keys, Settings& settings, std::string_view list = "keys") {
  read_entries(node, path, list, keys, settings.places,
               [&](const YamlNode& item, const std::string& below, Key& key) {
                 read_key(item, below, rows, key, settings);
                 if (keys.size() > 1 && !(key.time > keys[keys.size() - 2].time))
                   throw bad_input(settings.place(below + ".time"),
                                   "keys are not in ascending time",
                                   "sort them, each with its own time");
               });
}

/// Throws bad input where two entries of the list at `path` have the same name.
template <class Owner>
void check_names(const std::vector<Owner>& owners, const std::string& path, std::string_view list,
                 const Settings& settings) {
  std::set<std::string> seen;
  for (std::size_t i = 0; i < owners.size(); ++i)
    if (!seen.insert(owners[i].name).second)
      throw bad_input(settings.place(path_of_entry(path, list, i) + ".name"),
                      "two of " + path_below(path, list) + " are named '" + owners[i].name + '\'',
                      "give each a name of its own");
}

/// Keys that turn something: their axes have a length.
void check_axes_of_keys(const std::vector<PlaceKeySettings>& keys, const std::string& path,
                        const Settings& settings);

/// Throws bad input for a box or a ball that is incomplete, and for both.
void check_region(const RegionSettings& region, const std::string& path, const Settings& settings);

/// One list, `NAME:` and its entries; `entry`: the text of one, and whether it is the first.
template <class Owner, class Entry>
std::string list_text(std::string_view name, const std::vector<Owner>& owners, std::size_t indent,
                      const Entry& entry) {
  std::string text = std::string(indent, ' ') + std::string(name) + ':';
  if (owners.empty()) return text + " []\n";
  text += '\n';
  for (const Owner& owner : owners) text += entry(owner, &owner == &owners.front());
  return text;
}

/// The list of an entry's keys, which is itself indented by `indent` spaces.
template <class Owner>
std::string keys_text(std::span<const Field<typename decltype(Owner::keys)::value_type>> rows,
                      const Owner& owner, std::size_t indent, bool first) {
  return list_text("keys", owner.keys, indent + 2, [&](const auto& key, bool first_key) {
    return entry_text(rows, key, indent + 4, first && first_key);
  });
}

}  // namespace sinew
