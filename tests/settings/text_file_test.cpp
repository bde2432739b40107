// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/settings/text_file.h>

#include <gtest/gtest.h>

namespace sinew::text_file_test {

bool is_text(const std::string& text) {
  try {
    check_text(text, "a.yaml");
  } catch (const Error&) {
    return false;
  }
  return true;
}

TEST(CheckText, TakesTheFirstAndLastCharacterOfEachLength) {
  for (const char* text : {"\xC2\x80", "\xDF\xBF", "\xE0\xA0\x80", "\xED\x9F\xBF", "\xEE\x80\x80",
                           "\xEF\xBF\xBF", "\xF0\x90\x80\x80", "\xF4\x8F\xBF\xBF"})
    EXPECT_TRUE(is_text(text));
}

TEST(CheckText, RefusesWhatIsNotUtf8) {
  const char* const wrong[] = {"\x80",              // begins in the middle
                               "\xC1\xBF",          // longer than needed
                               "\xE0\x9F\xBF",      //
                               "\xF0\x8F\xBF\xBF",  //
                               "\xED\xA0\x80",      // a surrogate
                               "\xF4\x90\x80\x80",  // above U+10FFFF
                               "\xF5\x80\x80\x80",  //
                               "\xC2",              // cut short
                               "\xE2\x82",          //
                               "\xE2\x82"
                               "a",             //
                               "\xF0\x90\x80",  //
                               "\xFF"};
  for (const char* text : wrong) EXPECT_FALSE(is_text(text)) << testing::PrintToString(text);
}

TEST(Places, CountCharactersAndComeBack) {
  const std::string text = "ab\nüx: 1\r\n骨y";
  for (std::size_t offset : {0, 2, 3, 5, 6, 10, 11, 14}) {
    const Place place = place_of(text, offset, "a.yaml");
    EXPECT_EQ(offset_of(text, place), offset);
  }
  EXPECT_EQ(place_of(text, 5, "a.yaml").text(), "a.yaml:2:2");
  EXPECT_EQ(place_of(text, 14, "a.yaml").text(), "a.yaml:3:2");
  EXPECT_EQ(offset_of(text, {"", 9, 9}), text.size());
}

}  // namespace sinew::text_file_test
