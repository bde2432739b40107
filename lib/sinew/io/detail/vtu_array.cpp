// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/detail/vtu_array.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include <sinew/core/parallel.h>
#include <sinew/core/system.h>
#include <sinew/core/text.h>

namespace sinew {
namespace {

constexpr std::size_t values_at_a_time = 1 << 15;
constexpr std::uint64_t max_components = 1000;
constexpr double unasked_bytes = 64 << 20;

Error of_array(const XmlElement& array, const std::string& what) {
  return vtu_refused("array " + quoted(array.attribute("Name")) + ' ' + what);
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  return text.substr(0, text.find_last_not_of(blanks) + 1);
}

/// Calls act(zero) with a zero of the array's type.
template <class Act>
void with_type(const XmlElement& array, Act act) {
  const auto type = array.attribute("type");
  if (type == "Int8") return act(std::int8_t{});
  if (type == "UInt8") return act(std::uint8_t{});
  if (type == "Int16") return act(std::int16_t{});
  if (type == "UInt16") return act(std::uint16_t{});
  if (type == "Int32") return act(std::int32_t{});
  if (type == "UInt32") return act(std::uint32_t{});
  if (type == "Int64") return act(std::int64_t{});
  if (type == "UInt64") return act(std::uint64_t{});
  if (type == "Float32") return act(float{});
  if (type == "Float64") return act(double{});
  throw of_array(array, "is not numeric");
}

template <class Number>
std::optional<Decoded> from_words(std::string_view text, std::uint64_t count) {
  if (count > text.size()) return std::nullopt;
  Decoded numbers;
  numbers.own.resize(count * sizeof(Number));
  for (std::size_t i = 0; i < count; ++i) {
    text = trimmed(text);
    Number number;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc()) return std::nullopt;
    std::memcpy(&numbers.own[i * sizeof number], &number, sizeof number);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  }
  numbers.bytes = {reinterpret_cast<const char*>(numbers.own.data()), numbers.own.size()};
  return numbers;
}

/// Few bytes may hold many values, compressed: their memory is asked for before they are inflated.
void check_memory(const XmlElement& array, std::uint64_t count, std::size_t value_size) {
  const double bytes =
      static_cast<double>(count) * static_cast<double>(value_size + sizeof(double));
  if (bytes < unasked_bytes) return;
  const double available = available_memory();
  if (bytes <= available / 2) return;
  throw bad_input("array " + quoted(array.attribute("Name")) + " takes " + bytes_text(bytes) +
                      " of memory, more than half of the " + bytes_text(available) +
                      " that are free",
                  "make the file smaller, or read it on a larger machine");
}

template <class Number>
Decoded numbers_of(const XmlElement& array, const VtuArrays& file, std::uint64_t count) {
  check_memory(array, count, sizeof(Number));
  const auto format = array.attribute("format");
  std::optional<Decoded> numbers;
  if (format == "appended") {
    const auto offset = std::min<std::uint64_t>(file.count(array, "offset"), file.appended.size());
    numbers = decoded(file.appended.substr(offset), file.behind, count * sizeof(Number));
  } else if (format == "binary") {
    numbers = decoded(trimmed(array.text), file.within, count * sizeof(Number));
  } else if (format == "ascii" || format.empty()) {
    numbers = from_words<Number>(array.text, count);
  }
  if (!numbers) throw of_array(array, "is damaged");
  return *std::move(numbers);
}

template <class From>
From number_at(std::string_view bytes, std::size_t i) {
  From number;
  std::memcpy(&number, bytes.data() + i * sizeof number, sizeof number);
  return number;
}

template <class From, class To>
void convert(std::string_view bytes, To* to) {
  const std::size_t count = bytes.size() / sizeof(From);
  parallel_for(count, values_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      to[i] = static_cast<To>(
          number_at<From>(bytes, i));  // NOLINT(bugprone-signed-char-misuse): a number
  });
}

template <class From, class To>
std::vector<To> converted(std::string_view bytes) {
  std::vector<To> values(bytes.size() / sizeof(From));
  convert<From>(bytes, values.data());
  return values;
}

template <class From>
bool fit_int32(std::string_view bytes) {
  if constexpr (std::is_floating_point_v<From>) return false;
  if constexpr (std::is_integral_v<From> && sizeof(From) >= 4 &&
                !std::is_same_v<From, std::int32_t>)
    for (std::size_t i = 0; i < bytes.size() / sizeof(From); ++i)
      if (!std::in_range<std::int32_t>(number_at<From>(bytes, i))) return false;
  return true;
}

std::uint64_t components_of(const XmlElement& array, const VtuArrays& file) {
  if (array.attribute("NumberOfComponents").empty()) return 1;
  const std::uint64_t components = file.count(array, "NumberOfComponents");
  if (components == 0 || components > max_components)
    throw of_array(array, "has " + std::to_string(components) + " components");
  return components;
}

}  // namespace

Error vtu_refused(const std::string& what) {
  return bad_input(what, "write it again, with ParaView for example");
}

std::string quoted(std::string_view text) { return '\'' + std::string(text.substr(0, 60)) + '\''; }

std::uint64_t VtuArrays::count(const XmlElement& element, const char* attribute) const {
  const auto text = element.attribute(attribute);
  std::uint64_t count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (error != std::errc() || end != text.data() + text.size() || count > most)
    throw vtu_refused(std::string(attribute) + " is " + quoted(text) +
                      ", which its size cannot hold");
  return count;
}

std::size_t size_of_type(const XmlElement& array) {
  std::size_t size = 0;
  with_type(array, [&](auto zero) { size = sizeof zero; });
  return size;
}

Column VtuArrays::column(const XmlElement& array, std::uint64_t rows) const {
  const std::uint64_t components = components_of(array, *this);
  Column column{std::string(array.attribute("Name")), static_cast<int>(components), {}};
  with_type(array, [&](auto zero) {
    using From = decltype(zero);
    const Decoded numbers = numbers_of<From>(array, *this, rows * components);
    if (fit_int32<From>(numbers.bytes))
      column.values = converted<From, std::int32_t>(numbers.bytes);
    else
      column.values = converted<From, double>(numbers.bytes);
  });
  return column;
}

Points VtuArrays::points(const XmlElement& array, std::uint64_t rows) const {
  if (components_of(array, *this) != 3) throw of_array(array, "does not have 3 components");
  Points points;
  with_type(array, [&](auto zero) {
    using From = decltype(zero);
    const Decoded numbers = numbers_of<From>(array, *this, 3 * rows);
    points.resize(rows);
    if (rows > 0) convert<From>(numbers.bytes, points.front().data());
  });
  return points;
}

}  // namespace sinew
