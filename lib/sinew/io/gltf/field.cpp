// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/field.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include <sinew/core/text.h>
#include <sinew/io/gltf/checks.h>

namespace sinew {
namespace {

using Json = nlohmann::json;

constexpr int deepest = 100;               // real files nest to about 10
constexpr std::int64_t most_values = 4e6;  // each takes some 100 bytes once parsed
constexpr std::size_t most_items = 100'000;

/// Index of the quote that ends the string beginning at `at`.
std::size_t end_of_string(std::string_view json, std::size_t at) {
  for (++at; at < json.size() && json[at] != '"'; ++at)
    if (json[at] == '\\') ++at;
  return at;
}

/// Before parsing: what is nested deeply is later copied and freed by recursion.
void check_extent(std::string_view json) {
  int depth = 0;
  std::int64_t values = 0;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (c == '"') i = end_of_string(json, i);
    if (c == ']' || c == '}') --depth;
    if (c == '[' || c == '{') ++depth;
    if (c == '[' || c == '{' || c == ',') ++values;
    if (depth > deepest) throw damaged_gltf("its JSON is nested more than 100 deep");
    if (values > most_values) throw damaged_gltf("its JSON holds more than 4 million values");
  }
}

Json parsed(std::string_view text) {
  check_extent(text);
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    throw damaged_gltf("its JSON is damaged at byte " + std::to_string(error.byte));
  } catch (const Json::out_of_range&) {
    throw damaged_gltf("its JSON holds a number too large for any computer");
  }
}

/// The integer that a JSON number stands for: 100 may be written 1e2.
std::optional<std::int64_t> integer_in(const Json& value) {
  constexpr double most_exact = 9007199254740992;  // 2^53
  if (value.is_number_unsigned() && value.get<std::uint64_t>() > INT64_MAX) return std::nullopt;
  if (value.is_number_integer()) return value.get<std::int64_t>();
  if (!value.is_number_float()) return std::nullopt;
  const double number = value.get<double>();
  if (std::abs(number) > most_exact || number != std::floor(number)) return std::nullopt;
  return static_cast<std::int64_t>(number);
}

const Json& json(const std::shared_ptr<const void>& value) {
  return *static_cast<const Json*>(value.get());
}

Error wrong(const std::string& name, const Json& value, const std::string& wanted) {
  const std::string what =
      value.is_primitive() ? shown(value.dump()) : std::string("an ") + value.type_name();
  return damaged_gltf((name.empty() ? "its JSON" : name) + " is " + what + ", not " + wanted);
}

std::int64_t whole_in(const Json& value, const std::string& name, std::int64_t least,
                      std::int64_t most) {
  const auto number = integer_in(value);
  if (!number || *number < least || *number > most)
    throw wrong(name, value,
                "a whole number between " + std::to_string(least) + " and " + std::to_string(most));
  return *number;
}

int index_in(const Json& value, const std::string& name) {
  return static_cast<int>(whole_in(value, name, 0, most_gltf_bytes));
}

double number_in(const Json& value, const std::string& name) {
  if (!value.is_number()) throw wrong(name, value, "a number");
  const double number = value.get<double>();
  if (!(std::abs(number) <= FLT_MAX))
    throw damaged_gltf(name + " holds " + shown(value.dump()) + ", too large for a float");
  return number;
}

/// The elements of an array that may not be given.
const Json& array_in(const std::shared_ptr<const void>& value, const std::string& name) {
  static const Json none = Json::array();
  if (value && !json(value).is_array()) throw wrong(name, json(value), "an array");
  return value ? json(value) : none;
}

}  // namespace

GltfField::GltfField(std::string_view text) : value_(std::make_shared<const Json>(parsed(text))) {}

GltfField::GltfField(std::shared_ptr<const void> value, std::string name)
    : value_(std::move(value)), name_(std::move(name)) {}

GltfField GltfField::operator[](const char* key) const {
  const std::string name = name_.empty() ? key : name_ + '.' + key;
  if (!given()) return {nullptr, name};
  if (!json(value_).is_object()) throw wrong(name_, json(value_), "an object");
  const auto found = json(value_).find(key);
  if (found == json(value_).end()) return {nullptr, name};
  return {std::shared_ptr<const void>(value_, &*found), name};
}

std::vector<GltfField> GltfField::items() const {
  std::vector<GltfField> items;
  const Json& list = array_in(value_, name_);
  if (list.size() > most_items)
    throw bad_input(name_ + " lists " + std::to_string(list.size()) + " items, more than 100000",
                    "export only what is needed");
  for (const Json& item : list)
    items.push_back({std::shared_ptr<const void>(value_, &item), nth(name_.c_str(), items.size())});
  return items;
}

std::int64_t GltfField::whole(std::int64_t least, std::int64_t most) const {
  if (!given()) throw damaged_gltf(name_ + " is missing");
  return whole_in(json(value_), name_, least, most);
}

std::int64_t GltfField::whole_or(std::int64_t other) const { return given() ? whole(0) : other; }

std::vector<int> GltfField::indices() const {
  std::vector<int> indices;
  for (const Json& item : array_in(value_, name_)) indices.push_back(index_in(item, name_));
  return indices;
}

std::map<std::string, int> GltfField::named_indices() const {
  std::map<std::string, int> named;
  if (!given()) return named;
  if (!json(value_).is_object()) throw wrong(name_, json(value_), "an object");
  for (const auto& [key, value] : json(value_).items())
    named[key] = index_in(value, name_ + '.' + shown(key));
  return named;
}

std::vector<double> GltfField::numbers(std::size_t count) const {
  std::vector<double> numbers;
  for (const Json& item : array_in(value_, name_)) numbers.push_back(number_in(item, name_));
  if (given() && numbers.size() != count)
    throw damaged_gltf(name_ + " holds " + std::to_string(numbers.size()) + " numbers, not " +
                       std::to_string(count));
  return numbers;
}

std::string GltfField::text() const {
  if (!given()) throw damaged_gltf(name_ + " is missing");
  if (!json(value_).is_string()) throw wrong(name_, json(value_), "text");
  return json(value_).get<std::string>();
}

std::string GltfField::given_name() const {
  std::string name = (*this)["name"].text_or_none();
  const auto unprintable = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
  std::replace_if(name.begin(), name.end(), unprintable, '?');
  return name;
}

std::vector<std::string> GltfField::texts() const {
  std::vector<std::string> texts;
  for (const GltfField& item : items()) texts.push_back(item.text());
  return texts;
}

bool GltfField::flag() const {
  if (given() && !json(value_).is_boolean()) throw wrong(name_, json(value_), "true or false");
  return given() && json(value_).get<bool>();
}

}  // namespace sinew
