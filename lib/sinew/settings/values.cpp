// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/settings/values.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include <sinew/core/text.h>
#include <sinew/core/vector.h>

namespace sinew {

namespace {

using Kind = YamlNode::Kind;

/// A value together with what messages about it need.
struct Given {
  const YamlNode& node;
  const std::string& path;
  const Rules& rules;
};

std::string what_stands(const YamlNode& node) {
  switch (node.kind) {
    case Kind::empty:
      return "empty";
    case Kind::scalar:
      return shown(node.text);
    case Kind::list:
      return "a list";
    case Kind::map:
      return "a group of keys";
  }
  return "";
}

Error wrong(const Given& given, const std::string& fault) {
  return bad_input(given.node.place, given.path + " is " + what_stands(given.node) + fault,
                   "give " + values_text(given.rules));
}

/// A number without sign rules of its own: "-1.5e3", ".5". Too large becomes infinite.
std::optional<double> parse_decimal(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  const auto is_part = [](char c) {
    return (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+' || c == 'e' || c == 'E';
  };
  if (!std::all_of(text.begin(), text.end(), is_part)) return std::nullopt;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size()) return std::nullopt;
  if (error == std::errc::result_out_of_range) {
    const bool tiny = text.find("e-") != text.npos || text.find("E-") != text.npos;
    return tiny ? 0 : std::numeric_limits<double>::infinity();
  }
  return error == std::errc() ? std::optional(value) : std::nullopt;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

/// .inf, -.INF, .NaN, inf, nan: YAML's words and what people write for them.
bool is_not_finite(std::string_view text) {
  std::string word;
  for (const char c : text)
    if (c != '.' && c != '+' && c != '-')
      word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return word == "inf" || word == "infinity" || word == "nan";
}

double read_number(const Given& given) {
  const YamlNode& node = given.node;
  const char* kind =
      given.rules.kind == FieldKind::whole ? ", not a whole number" : ", not a number";
  if (node.kind == Kind::empty) throw wrong(given, "");
  if (node.kind != Kind::scalar) throw wrong(given, kind);
  if (node.quoted) throw wrong(given, " in quotes, a text");
  const auto value = parse_number(node.text);
  if (!value) throw wrong(given, kind);
  if (!std::isfinite(*value)) throw wrong(given, ", not a finite number");
  if (!is_computable(*value)) throw wrong(given, ", which is too large to compute with");
  return *value;
}

FieldValue read_bounded(const Given& given) {
  const double value = read_number(given);
  const bool whole = given.rules.kind == FieldKind::whole;
  if (whole && value != std::floor(value)) throw wrong(given, ", not a whole number");
  const bool fits = !whole || std::abs(value) <= std::numeric_limits<int>::max();
  if (!fits || !given.rules.range.holds(value)) throw wrong(given, ", out of range");
  return whole ? FieldValue(static_cast<int>(value)) : FieldValue(value);
}

FieldValue read_flag(const Given& given) {
  const YamlNode& node = given.node;
  const bool is_true = node.text == "true", is_false = node.text == "false";
  if (node.kind != Kind::scalar || node.quoted || !(is_true || is_false)) throw wrong(given, "");
  return is_true;
}

std::string read_word(const Given& given) {
  const std::string& text = given.node.text;
  if (given.node.kind == Kind::empty) throw wrong(given, "");
  if (given.node.kind != Kind::scalar) throw wrong(given, ", not a text");
  const auto is_control = [](unsigned char c) { return std::iscntrl(c) != 0; };
  if (std::any_of(text.begin(), text.end(), is_control)) throw wrong(given, ", more than one line");
  if (text.empty()) throw wrong(given, ", empty");
  return text;
}

FieldValue read_choice(const Given& given) {
  const std::string word = read_word(given);
  const auto& choices = given.rules.choices;
  if (std::find(choices.begin(), choices.end(), word) == choices.end())
    throw bad_input(given.node.place, given.path + " is " + shown(word), suggestion(word, choices));
  return word;
}

/// `count` numbers, or any number of them but none for 0; `words` names that count.
std::vector<double> read_list(const Given& given, std::size_t count, const std::string& words) {
  const YamlNode& node = given.node;
  if (node.kind == Kind::empty) throw wrong(given, "");
  if (node.kind != Kind::list) throw wrong(given, ", not a list of " + words + " numbers");
  if (count == 0 && node.items.empty()) throw wrong(given, " without values");
  if (count > 0 && node.items.size() != count)
    throw wrong(given, " of " + std::to_string(node.items.size()) + " values, not of " + words);
  const Rules number = {FieldKind::number, given.rules.unit, given.rules.range, {}, {}};
  std::vector<double> values;
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const std::string path = given.path + '[' + std::to_string(i) + ']';
    values.push_back(std::get<double>(read_bounded({node.items[i], path, number})));
  }
  return values;
}

FieldValue read_vector(const Given& given) {
  const std::vector<double> values = read_list(given, 3, "three");
  return Vec3(values[0], values[1], values[2]);
}

/// The word of a choice, or a list of lists of two names.
FieldValue read_pairs(const Given& given) {
  const YamlNode& node = given.node;
  if (node.kind == Kind::empty) throw wrong(given, "");
  if (node.kind == Kind::scalar) return read_choice(given);
  if (node.kind != Kind::list) throw wrong(given, ", not a list of pairs");
  if (node.items.empty()) throw wrong(given, " without pairs");
  std::vector<NamePair> pairs;
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const std::string path = given.path + '[' + std::to_string(i) + ']';
    const Given pair{node.items[i], path, given.rules};
    if (pair.node.kind != Kind::list || pair.node.items.size() != 2)
      throw wrong(pair, ", not a pair of names");
    NamePair& names = pairs.emplace_back();
    for (std::size_t k = 0; k < names.size(); ++k)
      names[k] = read_word({pair.node.items[k], path, given.rules});
  }
  return pairs;
}

std::string kind_text(const Rules& rules) {
  switch (rules.kind) {
    case FieldKind::number:
      return "a number";
    case FieldKind::whole:
      return "a whole number";
    case FieldKind::text:
      return "a text";
    case FieldKind::path:
      return "the path of a file";
    case FieldKind::choice:
      return "one of " + listed(rules.choices);
    case FieldKind::flag:
      return "true or false";
    case FieldKind::vector:
      return "[x, y, z]";
    case FieldKind::numbers:
      return rules.count == 0 ? "a list of numbers"
                              : "a list of " + std::to_string(rules.count) + " numbers";
    case FieldKind::pairs:
      return "a list of pairs of names, as [[hand, thigh]], or " + listed(rules.choices);
  }
  return "";
}

}  // namespace

std::string values_text(const Rules& rules) {
  std::string text = kind_text(rules);
  if (const std::string range = rules.range.text(); !range.empty()) text += ' ' + range;
  if (!rules.unit.empty()) text += " (" + std::string(rules.unit) + ')';
  if (!rules.absent.empty()) text += ", or " + std::string(rules.absent);
  return text;
}

std::optional<double> parse_number(std::string_view text) {
  if (is_not_finite(text)) return std::numeric_limits<double>::quiet_NaN();
  const auto slash = text.find('/');
  if (slash == text.npos) return parse_decimal(text);
  const auto above = parse_decimal(trimmed(text.substr(0, slash)));
  const auto below = parse_decimal(trimmed(text.substr(slash + 1)));
  if (!above || !below) return std::nullopt;
  return *below == 0 ? std::numeric_limits<double>::quiet_NaN() : *above / *below;
}

FieldValue read_value(const YamlNode& node, const std::string& path, const Rules& rules) {
  const Given given = {node, path, rules};
  const bool is_absent = node.kind == Kind::scalar && !node.quoted && node.text == rules.absent;
  if (is_absent && !rules.absent.empty()) return {};
  switch (rules.kind) {
    case FieldKind::number:
    case FieldKind::whole:
      return read_bounded(given);
    case FieldKind::flag:
      return read_flag(given);
    case FieldKind::choice:
      return read_choice(given);
    case FieldKind::vector:
      return read_vector(given);
    case FieldKind::numbers:
      return read_list(given, rules.count, rules.count == 0 ? "any" : std::to_string(rules.count));
    case FieldKind::pairs:
      return read_pairs(given);
    case FieldKind::text:
    case FieldKind::path:
      break;
  }
  return read_word(given);
}

namespace {

using Kind = YamlNode::Kind;

/// Every place in a scene where the table has a key of this name.
std::vector<std::string> homes_of(std::string_view name) {
  std::vector<std::string> homes;
  const auto search = [&](const auto& rows, const std::string& path) {
    for (const auto& row : rows)
      if (row.name == name) homes.push_back(path.empty() ? std::string(row.section) : path);
  };
  search(settings_table(), "");
  search(bone_fields(), "skeleton.bones");
  search(limit_fields(), "skeleton.bones[].limits");
  search(part_fields(), "bodies");
  search(bound_fields(), "binding.explicit");
  search(track_fields(), "motion.tracks");
  search(key_fields(), "motion.tracks[].keys");
  search(obstacle_fields(), "world.obstacles");
  search(friction_key_fields(), "world.obstacles[].friction_keys");
  search(pin_fields(), "world.pins");
  search(field_fields(), "world.fields");
  search(strength_fields(), "world.fields[].keys");
  search(muscle_fields(), "world.muscles");
  search(activation_fields(), "world.muscles[].keys");
  search(spring_fields(), "world.springs");
  search(spring_key_fields(), "world.springs[].keys");
  search(support_fields(), "supports");
  search(load_fields(), "loads");
  search(factor_fields(), "loads[].keys");
  search(material_fields(), "materials");
  search(probe_fields(), "probes");
  return homes;
}

std::string cure_for(std::string_view key, std::span<const std::string_view> known) {
  const auto homes = homes_of(key);
  const bool misplaced = nearest(key, known).empty() && !homes.empty();
  if (misplaced) return "it belongs into " + homes.front() + ", check the indentation";
  return suggestion(key, known);
}

}  // namespace

std::string path_below(const std::string& path, std::string_view key) {
  return path.empty() ? std::string(key) : path + '.' + std::string(key);
}

std::string path_of_entry(const std::string& path, std::string_view list, std::size_t index) {
  return path_below(path, list) + '[' + std::to_string(index) + ']';
}

void check_keys(const YamlNode& node, const std::string& path,
                std::span<const std::string_view> known) {
  const std::string name = path.empty() ? "a scene" : path;
  if (node.kind != Kind::map && node.kind != Kind::empty)
    throw bad_input(node.place, name + " must be a group of keys",
                    "write its keys below it, one 'key: value' a line: " + listed(known));
  for (const YamlKey& key : node.keys)
    if (std::find(known.begin(), known.end(), key.name) == known.end())
      throw bad_input(key.place, "unknown key " + shown(key.name) + " in " + name,
                      cure_for(key.name, known));
}

std::span<const YamlNode> list_below(const YamlNode& node, const std::string& path,
                                     std::string_view key, Places& places) {
  const std::string below = path_below(path, key);
  const YamlNode* list = node.find(key);
  const std::string cure = "write its entries below it, each beginning with '- '";
  if (list == nullptr)
    throw bad_input(node.place, below + " is missing", "add " + std::string(key) + ": and " + cure);
  if (list->kind != Kind::list) throw bad_input(list->place, below + " must be a list", cure);
  if (list->items.empty()) throw bad_input(list->place, below + " has no entries", cure);
  places[below] = list->place;
  for (std::size_t i = 0; i < list->items.size() && places.size() < max_places; ++i)
    places[below + '[' + std::to_string(i) + ']'] = list->items[i].place;
  return list->items;
}

Error missing_key(const YamlNode& node, const std::string& path, const Rules& rules) {
  const std::string key = path.substr(path.rfind('.') + 1);
  return bad_input(node.place, path + " is missing", "add " + key + ": with " + values_text(rules));
}

}  // namespace sinew
