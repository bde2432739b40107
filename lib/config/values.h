// SPDX-License-Identifier: GPL-3.0-or-later
// One value of a scene, checked against its row in the table of settings.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "config/yaml_tree.h"
#include "core/settings_table.h"

namespace sinew {

/// What a row of the table asks of its value, whoever owns it.
struct Rules {
  FieldKind kind;
  std::string_view unit;
  Range range;
  std::span<const std::string_view> choices;
  std::string_view absent;
  std::size_t count = 0;  ///< of a list of numbers
};

template <class Owner>
Rules rules_of(const Field<Owner>& row) {
  return {row.kind, row.unit, row.range, row.choices, row.absent, row.count};
}

/// "a number > 0 (m), or auto": what may be given.
std::string values_text(const Rules& rules);

/// The value of `node`, or monostate for the absent word. Throws bad input, naming the value's
/// place and `path` ("body.radius"), for another type, a number out of range or not finite, an
/// unknown choice, an empty text.
FieldValue read_value(const YamlNode& node, const std::string& path, const Rules& rules);

/// A decimal number or a fraction such as 1/30; nothing when the text is neither. Infinite or not a
/// number where the text says so, is too large for a double, or divides by zero.
std::optional<double> parse_number(std::string_view text);

}  // namespace sinew
