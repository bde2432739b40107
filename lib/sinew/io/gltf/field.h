// SPDX-License-Identifier: GPL-3.0-or-later
// One value of a glTF file's JSON, taken as what it should be or refused by its name.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/io/gltf/container.h>

namespace sinew {

/// A value, or the lack of one, and its name in messages: "accessors[3].count". Every function
/// throws bad input (without the path) for a value of another kind. Numbers and texts that are not
/// given are refused as well, lists that are not given are empty.
class GltfField {
 public:
  /// The whole of a JSON text. Throws bad input when it is damaged, nests more than 100 deep or
  /// holds more than 4 million values.
  explicit GltfField(std::string_view json);

  bool given() const { return value_ != nullptr; }
  const std::string& name() const { return name_; }

  GltfField operator[](const char* key) const;  ///< of an object
  std::vector<GltfField> items() const;         ///< of an array

  std::int64_t whole(std::int64_t least, std::int64_t most = most_gltf_bytes) const;
  std::int64_t whole_or(std::int64_t other) const;  ///< 0 or more
  int index() const { return static_cast<int>(whole(0)); }
  int index_or_none() const { return given() ? index() : -1; }
  std::vector<int> indices() const;
  std::map<std::string, int> named_indices() const;  ///< an object's

  /// `count` numbers that fit single precision, or none.
  std::vector<double> numbers(std::size_t count) const;

  std::string text() const;
  std::string text_or_none() const { return given() ? text() : std::string(); }
  /// Of an object, "" where it has none. It will be printed: what no line can hold becomes '?'.
  std::string given_name() const;
  std::vector<std::string> texts() const;
  bool flag() const;  ///< false where it is not given

 private:
  GltfField(std::shared_ptr<const void> value, std::string name);

  std::shared_ptr<const void> value_;  // a part of the parser's tree, whose type stays in the .cpp
  std::string name_;
};

}  // namespace sinew
