// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/settings/values.h>

#include <gtest/gtest.h>
#include <cmath>
#include <cstring>
#include <random>

#include <sinew/core/text.h>

namespace sinew::values_test {

TEST(ParseNumber, ReadsDecimalsAndFractions) {
  EXPECT_EQ(parse_number("0.01"), 0.01);
  EXPECT_EQ(parse_number("-1.5e3"), -1500);
  EXPECT_EQ(parse_number("+.5"), 0.5);
  EXPECT_EQ(parse_number("1/30"), 1.0 / 30);
  EXPECT_EQ(parse_number("-1 / 4"), -0.25);
  EXPECT_EQ(parse_number("1e-400"), 0);
}

TEST(ParseNumber, RefusesOtherTexts) {
  for (const char* text :
       {"", "abc", "0x10", "1 2", "10mm", "1,5", "1/", "/2", "1/2/3", "--1", "e5"})
    EXPECT_FALSE(parse_number(text)) << text;
}

TEST(ParseNumber, SaysWhatIsNotFinite) {
  for (const char* text : {".nan", ".inf", "-.INF", "nan", "inf", "1e999", "1/0", "0/0", "-1e999"})
    EXPECT_FALSE(std::isfinite(parse_number(text).value())) << text;
}

TEST(ParseNumber, ReadsBackWhatNumberTextWrites) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 10'000; ++i) {
    const std::uint64_t bits = random();
    double value;
    std::memcpy(&value, &bits, sizeof value);
    if (!std::isfinite(value)) continue;
    EXPECT_EQ(parse_number(number_text(value)), value);
  }
}

TEST(ValuesText, SaysWhatMayBeGiven) {
  const Rules rules = {FieldKind::number, "m", {0, 1, true}, {}, "auto"};
  EXPECT_EQ(values_text(rules), "a number > 0, up to 1 (m), or auto");
}

TEST(Words, NearestForgivesSmallMistakes) {
  const std::vector<std::string_view> names = {"radius", "count", "packing", "time_step",
                                               "tail",   "a",     "b"};
  EXPECT_EQ(nearest("raduis", names), "radius");
  EXPECT_EQ(nearest("Count", names), "count");
  EXPECT_EQ(nearest("tial", names), "tail");
  EXPECT_EQ(nearest("timestep", names), "time_step");
  EXPECT_EQ(nearest("step", names), "time_step");
  EXPECT_EQ(nearest("elephant", names), "");
  EXPECT_EQ(nearest("c", names), "");
  EXPECT_EQ(nearest(std::string(100'000, 'x'), names), "");
}

TEST(Words, ShownTextFitsALine) {
  EXPECT_EQ(shown("a\nb\x1b"), "'a?b?'");
  EXPECT_EQ(shown(std::string(1000, 'x')), "'" + std::string(40, 'x') + "...'");
  std::string umlauts;
  for (int i = 0; i < 50; ++i) umlauts += "ü";
  EXPECT_EQ(shown(umlauts).size(), 40 * 2 + 5u) << "cut between letters, not inside one";
}

}  // namespace sinew::values_test
