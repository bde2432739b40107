// SPDX-License-Identifier: GPL-3.0-or-later
// YAML text as a plain tree in which every value has its place in the text.
//
//     const YamlNode scene = parse_yaml(text, "scene.yaml");
//     const YamlNode* body = scene.find("body");
//
// Stricter than YAML: no duplicate keys, no tags, one document, and limits that keep hostile text
// (aliases of aliases, lists of lists) from exhausting memory.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <sinew/core/error.h>

namespace sinew {

/// Values in a text of that many bytes, aliases written out: those of a scene that sinew writes
/// have at least four bytes each.
constexpr std::size_t max_nodes(std::size_t bytes) { return 100'000 + bytes / 4; }
inline constexpr std::size_t deepest_node = 32;  // lists and mappings inside each other

/// A place in a file whose name all values of a tree share.
struct YamlPlace {
  YamlPlace() = default;
  YamlPlace(std::shared_ptr<const std::string> of, int at_line, int at_column)
      : file(std::move(of)), line(at_line), column(at_column) {}
  YamlPlace(const Place& place)
      : YamlPlace(std::make_shared<const std::string>(place.file), place.line, place.column) {}
  operator Place() const { return {file ? *file : std::string(), line, column}; }

  std::shared_ptr<const std::string> file;
  int line = 0, column = 0;
};

struct YamlKey {
  std::string name;
  YamlPlace place;
};

struct YamlNode {
  enum class Kind : unsigned char { empty, scalar, list, map };

  Kind kind = Kind::empty;
  bool quoted = false;          ///< the scalar is quoted, or is a block of text
  YamlPlace place;              ///< beginning of the value; for an empty one its key
  std::string text;             ///< text of a scalar
  std::vector<YamlNode> items;  ///< items of a list, or the values of a map
  std::vector<YamlKey> keys;    ///< keys of a map, one per item

  /// The value of a key, or nullptr.
  const YamlNode* find(std::string_view key) const;
};

/// Reads one document; empty text gives an empty node. Throws bad input, with `file`, line and
/// column, for invalid YAML and for what is excluded above.
YamlNode parse_yaml(std::string_view text, const std::string& file);

}  // namespace sinew
