// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of the settings tables: how to read and write a member of a settings struct.
//
//     choice<Settings>("body", "packing", SINEW_AT(Settings, body.packing), {"fcc", "hcp"}, help)
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>

#include <sinew/settings/table.h>

namespace sinew {

/// A value as YAML: numbers by number_text, true, [1, 2, 3]; texts quoted where YAML would read
/// them as something else; `absent` for a value that is not given.
std::string scene_text(const FieldValue& value, std::string_view absent);

}  // namespace sinew

// How a row is made.

namespace sinew::rows {

inline constexpr double inf = std::numeric_limits<double>::infinity();
inline constexpr Range any = {};
inline constexpr Range positive = {0, inf, true};
inline constexpr Range not_negative = {0, inf, false};

template <class T>
struct Unwrap {
  using type = T;
  static constexpr bool optional = false;
};
template <class T>
struct Unwrap<std::optional<T>> {
  using type = T;
  static constexpr bool optional = true;
};

/// How many numbers a std::array holds; 0 for anything else.
template <class T>
constexpr std::size_t count_of = 0;
template <std::size_t n>
constexpr std::size_t count_of<std::array<double, n>> = n;

template <class T>
constexpr bool is_list = count_of<T> > 0 || std::is_same_v<T, std::vector<double>>;

/// Members as a FieldValue stores them: arrays become lists.
template <class T>
FieldValue stored_as_field(const T& value) {
  if constexpr (count_of < T >> 0)
    return std::vector<double>(value.begin(), value.end());
  else
    return value;
}

template <class T>
T from_field(const FieldValue& field) {
  if constexpr (count_of < T >> 0) {
    const auto& list = std::get<std::vector<double>>(field);
    T value{};
    std::copy_n(list.begin(), std::min(list.size(), value.size()), value.begin());
    return value;
  } else {
    return std::get<T>(field);
  }
}

template <class T>
constexpr FieldKind kind_of() {
  if constexpr (std::is_same_v<T, double>)
    return FieldKind::number;
  else if constexpr (std::is_same_v<T, int>)
    return FieldKind::whole;
  else if constexpr (std::is_same_v<T, bool>)
    return FieldKind::flag;
  else if constexpr (std::is_same_v<T, Vec3>)
    return FieldKind::vector;
  else if constexpr (is_list<T>)
    return FieldKind::numbers;
  else
    return FieldKind::text;
}

/// A row for the member that `member(owner)` refers to; optional members may be absent.
template <class Owner, class Member>
Field<Owner> field(std::string_view section, std::string_view name, Member member,
                   std::string_view unit, std::string_view help, Range range = any,
                   std::string_view absent = "auto") {
  using Stored = std::remove_reference_t<decltype(member(std::declval<Owner&>()))>;
  using Value = typename Unwrap<Stored>::type;
  Field<Owner> row;
  row.section = section;
  row.name = name;
  row.kind = kind_of<Value>();
  row.count = count_of<Value>;
  row.unit = unit;
  row.help = help;
  row.range = range;
  if (Unwrap<Stored>::optional) row.absent = absent;
  row.get = [member](const Owner& owner) -> FieldValue {
    const Stored& stored = member(const_cast<Owner&>(owner));
    if constexpr (Unwrap<Stored>::optional)
      return stored ? stored_as_field(*stored) : FieldValue();
    else
      return stored_as_field(stored);
  };
  row.set = [member](Owner& owner, const FieldValue& value) {
    if constexpr (Unwrap<Stored>::optional)
      if (std::holds_alternative<std::monostate>(value)) return member(owner).reset();
    member(owner) = from_field<Value>(value);
  };
  return row;
}

/// A row for an enum; `choices` in the order of its values. An optional one may be auto.
template <class Owner, class Member>
Field<Owner> choice(std::string_view section, std::string_view name, Member member,
                    const std::vector<std::string_view>& choices, std::string_view help) {
  using Stored = std::remove_reference_t<decltype(member(std::declval<Owner&>()))>;
  using Enum = typename Unwrap<Stored>::type;
  Field<Owner> row;
  row.section = section;
  row.name = name;
  row.kind = FieldKind::choice;
  row.help = help;
  row.choices = choices;
  if (Unwrap<Stored>::optional) row.absent = "auto";
  row.get = [member, choices](const Owner& owner) -> FieldValue {
    const std::optional<Enum> stored = member(const_cast<Owner&>(owner));
    if (!stored) return {};
    return std::string(choices[static_cast<std::size_t>(*stored)]);
  };
  row.set = [member, choices](Owner& owner, const FieldValue& value) {
    if constexpr (Unwrap<Stored>::optional)
      if (std::holds_alternative<std::monostate>(value)) return member(owner).reset();
    for (std::size_t i = 0; i < choices.size(); ++i)
      if (choices[i] == std::get<std::string>(value)) member(owner) = static_cast<Enum>(i);
  };
  return row;
}

template <class Owner>
Field<Owner> required(Field<Owner> row) {
  row.required = true;
  return row;
}

template <class Owner>
Field<Owner> path(Field<Owner> row) {
  row.kind = FieldKind::path;
  return row;
}

/// An optional text: the empty text is written as `word`.
template <class Owner>
Field<Owner> may_lack(std::string_view word, Field<Owner> row) {
  row.absent = word;
  row.get = [get = row.get](const Owner& owner) -> FieldValue {
    FieldValue value = get(owner);
    return std::get<std::string>(value).empty() ? FieldValue() : value;
  };
  row.set = [set = row.set](Owner& owner, const FieldValue& value) {
    set(owner, std::holds_alternative<std::monostate>(value) ? FieldValue(std::string()) : value);
  };
  return row;
}

/// Returns rows of section output: table_of_output.cpp.
std::vector<Field<Settings>> output_rows();

// Names a member: SINEW_AT(Settings, body.radius) is a function from Settings& to that member.
// Neither a type nor a member stands in parentheses. NOLINTBEGIN(bugprone-macro-parentheses)
#define SINEW_AT(Owner, member) \
  [](Owner & owner) -> auto& { return (owner).member; }
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace sinew::rows
