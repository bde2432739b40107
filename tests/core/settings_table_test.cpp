// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <algorithm>
#include <set>

#include <sinew/settings/row.h>
#include <sinew/settings/table.h>

namespace sinew::settings_table_test {

/// A value of the field's kind, in its range, that differs from `seed` to `seed`.
template <class Owner>
FieldValue sample(const Field<Owner>& field, int seed) {
  const double low = std::isfinite(field.range.low) ? field.range.low : -7.0;
  const double high = std::isfinite(field.range.high) ? field.range.high : low + 100;
  const double number = low + (high - low) * (seed + 1) / 4;
  switch (field.kind) {
    case FieldKind::number:
      return number;
    case FieldKind::whole:
      return static_cast<int>(number);
    case FieldKind::flag:
      return seed % 2 == 0;
    case FieldKind::vector:
      return Vec3(seed, 0.1, -2.5);
    case FieldKind::numbers: {
      std::vector<double> list(field.count == 0 ? 2 : field.count, -0.5);
      list.front() = seed;
      return list;
    }
    case FieldKind::choice:
      return std::string(field.choices[seed % field.choices.size()]);
    case FieldKind::pairs:
      if (seed == 0) return std::string(field.choices.front());
      return std::vector<NamePair>(static_cast<std::size_t>(seed), {"one", "other"});
    case FieldKind::text:
    case FieldKind::path:
      return "text" + std::to_string(seed);
  }
  return {};
}

template <class Owner>
std::vector<FieldValue> all_values(std::span<const Field<Owner>> table, const Owner& owner) {
  std::vector<FieldValue> values;
  for (const auto& field : table) values.push_back(field.get(owner));
  return values;
}

/// Each row writes its own member and no other, and reads back what it wrote.
template <class Owner>
void expect_round_trips(std::span<const Field<Owner>> table) {
  for (std::size_t row = 0; row < table.size(); ++row)
    for (int seed = 0; seed < 3; ++seed) {
      Owner owner;
      std::vector<FieldValue> expected = all_values(table, owner);
      expected[row] = sample(table[row], seed);
      table[row].set(owner, expected[row]);
      EXPECT_EQ(all_values(table, owner), expected) << table[row].name;
      if (table[row].absent.empty()) continue;
      expected[row] = FieldValue();
      table[row].set(owner, expected[row]);
      EXPECT_EQ(all_values(table, owner), expected) << table[row].name;
    }
}

template <class Owner>
void expect_well_formed(std::span<const Field<Owner>> table) {
  std::set<std::string> names;
  for (const auto& field : table) {
    EXPECT_TRUE(names.insert(std::string(field.section) + '.' + std::string(field.name)).second);
    EXPECT_FALSE(field.help.empty()) << field.name;
    EXPECT_EQ(field.help.find('\n'), std::string_view::npos) << field.name;
    EXPECT_TRUE(field.kind == FieldKind::numbers || field.count == 0) << field.name;
    EXPECT_EQ(field.kind == FieldKind::choice || field.kind == FieldKind::pairs,
              !field.choices.empty())
        << field.name;
    const auto& sections = sinew::sections();
    const bool known = std::find(sections.begin(), sections.end(), field.section) != sections.end();
    EXPECT_TRUE(field.section.empty() || known) << field.section;
  }
}

TEST(SettingsTable, EveryRowGetsAndSetsItsOwnMember) {
  expect_round_trips(settings_table());
  expect_round_trips(bone_fields());
  expect_round_trips(limit_fields());
  expect_round_trips(track_fields());
  expect_round_trips(key_fields());
  expect_round_trips(obstacle_fields());
  expect_round_trips(place_key_fields());
  expect_round_trips(friction_key_fields());
  expect_round_trips(pin_fields());
  expect_round_trips(field_fields());
  expect_round_trips(strength_fields());
  expect_round_trips(muscle_fields());
  expect_round_trips(activation_fields());
  expect_round_trips(spring_fields());
  expect_round_trips(spring_key_fields());
}

TEST(SettingsTable, IsWellFormed) {
  expect_well_formed(settings_table());
  expect_well_formed(bone_fields());
  expect_well_formed(limit_fields());
  expect_well_formed(track_fields());
  expect_well_formed(key_fields());
  expect_well_formed(obstacle_fields());
  expect_well_formed(place_key_fields());
  expect_well_formed(friction_key_fields());
  expect_well_formed(pin_fields());
  expect_well_formed(field_fields());
  expect_well_formed(strength_fields());
  expect_well_formed(muscle_fields());
  expect_well_formed(activation_fields());
  expect_well_formed(spring_fields());
  expect_well_formed(spring_key_fields());
}

TEST(SettingsTable, DefaultsLieInTheirRanges) {
  for (const auto& field : settings_table()) {
    const FieldValue value = field.get(Settings());
    const auto* number = std::get_if<double>(&value);
    EXPECT_TRUE(!number || field.range.holds(*number)) << field.name;
  }
}

TEST(SettingsTable, HasTheNamesScriptsRelyOn) {
  std::set<std::string> names;
  for (const auto& field : settings_table())
    names.insert(std::string(field.section) + '.' + std::string(field.name));
  for (const char* name :
       {"body.mesh", "body.radius", "body.count", "body.packing", "material.model",
        "material.density", "solver.integrator", "solver.time_step", "solver.duration",
        "solver.precision", "solver.neighbor_search", "output.interval"})
    EXPECT_TRUE(names.contains(name)) << name;
}

TEST(Range, HoldsItsLimitsButNoNan) {
  const double inf = std::numeric_limits<double>::infinity();
  const Range above = {0, inf, true}, fraction = {0, 1, false}, most = {-inf, 3, false};
  EXPECT_FALSE(above.holds(0));
  EXPECT_TRUE(above.holds(1e-300));
  EXPECT_TRUE(fraction.holds(0) && fraction.holds(1));
  EXPECT_FALSE(fraction.holds(1.0000001) || fraction.holds(-1e-9));
  for (const Range& range : {above, fraction, most, Range{}})
    EXPECT_FALSE(range.holds(std::nan("")));
  EXPECT_EQ(above.text(), "> 0");
  EXPECT_EQ(fraction.text(), "0 to 1");
  EXPECT_EQ(most.text(), "<= 3");
  EXPECT_EQ(Range{}.text(), "");
}

TEST(NumberText, ReadsBackAsTheSameNumber) {
  for (const double value : {0.1, 1.0 / 3, 1e-320, 1.7976931348623157e308, -0.0, 2.6, 1e22, 1e5}) {
    const std::string text = number_text(value);
    EXPECT_EQ(std::strtod(text.c_str(), nullptr), value) << text;
  }
  EXPECT_EQ(number_text(0.1), "0.1");
  EXPECT_EQ(number_text(4), "4");
}

TEST(SceneText, WritesEachKind) {
  EXPECT_EQ(scene_text(0.25, ""), "0.25");
  EXPECT_EQ(scene_text(12, ""), "12");
  EXPECT_EQ(scene_text(true, ""), "true");
  EXPECT_EQ(scene_text(Vec3(1, -0.5, 0), ""), "[1, -0.5, 0]");
  EXPECT_EQ(scene_text(FieldValue(), "auto"), "auto");
  EXPECT_EQ(scene_text(std::string("upper_arm"), ""), "upper_arm");
  EXPECT_EQ(scene_text(std::string("../data/box.obj"), ""), "../data/box.obj");
}

TEST(SceneText, QuotesWhatYamlWouldReadAsSomethingElse) {
  for (const std::string text :
       {"",    " a",   "a b",  "true", "False", "NULL", "~",    "yes",  "No",   "ON",
        "off", "y",    "N",    "12",   "-1",    ".5",   "0x1F", ".nan", ".Inf", "-.inf",
        "1e5", "a: b", "a #b", "[a]",  "{a}",   "- a",  "*a",   "&a",   "!a",   "%a",
        "@a",  "`a`",  "'a'",  "a,b",  "auto",  "none", "über", "...",  "---"})
    EXPECT_EQ(scene_text(text, ""), '"' + text + '"');
}

TEST(SceneText, EscapesWhatAQuotedTextCannotHold) {
  EXPECT_EQ(scene_text(std::string("say \"a\\b\""), ""), R"("say \"a\\b\"")");
  EXPECT_EQ(scene_text(std::string("a\nb\tc\x01"), ""), R"("a\x0ab\x09c\x01")");
}

}  // namespace sinew::settings_table_test
