// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include <sinew/core/text.h>

namespace sinew::words_test {

TEST(Shown, KeepsLettersOfAnyLanguage) {
  for (const char* text : {"", "radius", "\xC3\xA9", "\xE7\xAD\x8B", "\xF0\x9F\xA6\xB4"})
    EXPECT_EQ(shown(text), '\'' + std::string(text) + '\'');
}

TEST(Shown, ReplacesControlCharactersAndWhatIsNotUtf8) {
  EXPECT_EQ(shown("a\nb\x1b[2J\x7f"), "'a?b?[2J?'");
  const auto marks = [](int count) { return '\'' + std::string(count, '?') + '\''; };
  EXPECT_EQ(shown("\x80\xff\xC3"), marks(3));              // no letter begins or ends like this
  EXPECT_EQ(shown("\xC0\xAF\xED\xA0\x80"), marks(5));      // overlong; a surrogate
  EXPECT_EQ(shown("\xC2\x9B\xF4\x90\x80\x80"), marks(6));  // a control; beyond the last letter
}

TEST(Shown, CutsAfter40LettersWhateverTheBytes) {
  EXPECT_EQ(shown(std::string(40, 'x')).size(), 42u);
  EXPECT_EQ(shown(std::string(1000, 'x')), '\'' + std::string(40, 'x') + "...'");
  EXPECT_EQ(shown(std::string(1000, '\x80')), '\'' + std::string(40, '?') + "...'");
}

TEST(Printable, HasNothingThatATerminalObeys) {
  EXPECT_EQ(printable("a\x1b]0;b\x07\xC2\x9B\x9B\n\x7f \xC3\xBC"), "a?]0;b?????? \xC3\xBC");
}

TEST(ShellQuoted, IsOneWordOfPrintableLetters) {
  EXPECT_EQ(shell_quoted("out/a_b-1.yaml"), "out/a_b-1.yaml");
  EXPECT_EQ(shell_quoted(""), "''");
  EXPECT_EQ(shell_quoted("it's; \xC3\xBC"), "'it'\\''s; \xC3\xBC'");
  EXPECT_EQ(shell_quoted("a\x1b'\\\xFF"), "$'a\\x1b\\x27\\x5c\\xff'");
}

TEST(QuantityText, HasAPrefixOfTheSiWhereDigitsWouldBeMany) {
  EXPECT_EQ(quantity_text(2370, "Pa"), "2.37 kPa");
  EXPECT_EQ(quantity_text(1e6, "Pa"), "1 MPa");
  EXPECT_EQ(quantity_text(999.9, "Pa"), "1 kPa");
  EXPECT_EQ(quantity_text(0.00175, "m"), "1.75 mm");
  EXPECT_EQ(quantity_text(-3.2e-7, "N"), "-320 nN");
  EXPECT_EQ(quantity_text(0.05, "m"), "0.05 m");
  EXPECT_EQ(quantity_text(0, "J"), "0 J");
}

TEST(QuantityText, LeavesUnitsAloneThatTakeNoPrefix) {
  EXPECT_EQ(quantity_text(2370, "N/m"), "2.37e+03 N/m");
  EXPECT_EQ(quantity_text(1e-5, "m^2"), "1e-05 m^2");
}

TEST(QuantityText, IsOfTheSizeOfItsNumber) {
  for (int power = -14; power < 15; ++power)
    for (const double digits : {1.0, 2.5, 9.99}) {
      const double value = digits * std::pow(10, power);
      const PrefixedUnit shown = prefixed_unit(value, "Pa");
      EXPECT_GE(value / shown.size, power < -12 ? 0 : 0.00999) << value;
      EXPECT_LT(value / shown.size, 1000) << value;
    }
}

}  // namespace sinew::words_test
