// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/markup.h>

#include <gtest/gtest.h>

#include <cmath>

namespace sinew::test::markup_test {

TEST(Markup, NumbersHaveFourDigitsForReading) {
  EXPECT_EQ(readable(0), "0");
  EXPECT_EQ(readable(1), "1");
  EXPECT_EQ(readable(-0.0123456), "-0.01235");
  EXPECT_EQ(readable(1234.56), "1235");
  EXPECT_EQ(readable(98765.4), "98765");
  EXPECT_EQ(readable(1.5e-7), "1.500e-07");
  EXPECT_EQ(readable(100), "100");
  EXPECT_EQ(readable(std::nan("")), "–");
}

TEST(Markup, TextCannotLeaveItsElement) {
  EXPECT_EQ(escaped("<a href=\"x\">&'"), "&lt;a href=&quot;x&quot;&gt;&amp;&#39;");
  EXPECT_EQ(escaped(std::string("a\0b\x1b[31m\n", 9)), "ab[31m\n");
  EXPECT_EQ(escaped("Gänsefuß"), "Gänsefuß");
}

TEST(Markup, LinksStayRelative) {
  EXPECT_EQ(link_to("pictures/a b.png"), "pictures/a%20b.png");
  EXPECT_EQ(link_to("//host/x"), "host/x");
  EXPECT_EQ(link_to("javascript:x"), "javascript%3Ax");
  EXPECT_EQ(link_to("a?b#c%d\"e"), "a%3Fb%23c%25d%22e");
}

TEST(Markup, TablesEscapeTheirCellsAndLabelThem) {
  const std::string text = table({"what", "a<b"}, row("<b>x</b>", {{"a<b", "1<2"}}));
  EXPECT_NE(text.find("<td><b>x</b></td>"), std::string::npos);
  EXPECT_NE(text.find("data-label=\"a&lt;b\">1&lt;2</td>"), std::string::npos);
  EXPECT_NE(text.find("class=\"number\">a&lt;b</th>"), std::string::npos);
}

}  // namespace sinew::test::markup_test
