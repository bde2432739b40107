// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

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

}  // namespace sinew::words_test
