// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/detail/xml.h>

#include <gtest/gtest.h>

#include <sinew/core/error.h>

namespace sinew::xml_test {

std::string times(int count, const std::string& text) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

bool is_read(const std::string& xml) {
  try {
    return !xml_elements(xml).empty();
  } catch (const Error& error) {
    EXPECT_EQ(error.exit(), Exit::bad_input);
    return false;
  }
}

TEST(Xml, HasItsElementsInOrderWithTheirAttributesAndText) {
  const std::string xml =
      "<?xml version='1.0'?>\n<!-- <b> isn't one -->\n<a x=\"1 > 0\" y='&lt;\"&amp;'>\n"
      "<c>some & any<d/></c >after</a>\n";
  const auto elements = xml_elements(xml);
  ASSERT_EQ(elements.size(), 3u);
  EXPECT_EQ(elements[0].path, "a");
  EXPECT_EQ(elements[0].attribute("x"), "1 > 0");
  EXPECT_EQ(elements[0].attribute("y"), "<\"&");
  EXPECT_EQ(elements[0].attribute("z"), "");
  EXPECT_EQ(elements[0].text, "\n");
  EXPECT_EQ(elements[1].path, "a/c");
  EXPECT_EQ(elements[1].text, "some & any");
  EXPECT_EQ(elements[2].path, "a/c/d");
  EXPECT_EQ(elements[2].text, "");
}

TEST(Xml, IsNotLookedAtBehindTheLastElement) {
  const std::string xml = "<a><b>1</b><c x='2'>_\1\2<<<</c></a>";
  EXPECT_FALSE(is_read(xml));
  const auto elements = xml_elements(xml, "a/c");
  ASSERT_EQ(elements.size(), 3u);
  EXPECT_EQ(elements[1].text, "1");
  EXPECT_EQ(elements[2].attribute("x"), "2");
  EXPECT_EQ(elements[2].text, "_\1\2<<<</c></a>");
  EXPECT_EQ(xml_elements("<a><c/><b>1</b></a>", "a/c").back().text, "1");
}

TEST(Xml, BeginsWithAnyBlanks) {  // expat puts off what it could not make sense of at first
  const std::string blanks(10000, '\n');
  const auto elements =
      xml_elements("<?xml version='1.0'?>" + blanks + "<a>" + blanks + "<b>1</b></a>");
  ASSERT_EQ(elements.size(), 2u);
  EXPECT_EQ(elements[0].text, blanks);
  EXPECT_EQ(elements[1].text, "1");
}

TEST(Xml, IsReadInAMomentHoweverItIsMade) {
  const std::string endless(3'000'000, 'x');
  EXPECT_TRUE(is_read("<a>" + endless + "</a>"));
  EXPECT_TRUE(is_read("<a>" + times(100'000, "<b c='d'/>") + "</a>"));
  for (const std::string& xml :
       {endless, "<a/>" + endless, '<' + endless, "<a b=\"" + endless + "\"/>", "<a>&" + endless,
        "<?" + endless + "?><a/>", "<a><!--" + endless, times(1'000'000, "<a>"),
        "<a>" + times(300'000, "<b/>") + "</a>", times(1'000'000, "<!---->")})
    EXPECT_FALSE(is_read(xml)) << xml.substr(0, 10);
}

TEST(Xml, OfAnyDepthIsFreedWithoutRecursion) {
  EXPECT_TRUE(is_read(times(400, "<a>") + times(400, "</a>")));
  EXPECT_FALSE(is_read(times(100'000, "<a>") + times(100'000, "</a>")));
}

TEST(Xml, ThatIsNoneOrHasDeclarationsIsRefused) {
  for (const char* xml : {"", "a", "<a>", "</a>", "<a></b>", "<a/><b/>", "<a x='1' x='2'/>",
                          "<a x=1/>", "<a", "<a b='", "<a b='&c;'/>", "<a><![CDATA[b]]></a>",
                          "<!DOCTYPE a [<!ENTITY b 'c'>]><a>&b;</a>",
                          "<!DOCTYPE a SYSTEM 'file:///etc/passwd'><a/>", "<a b='\xff'/>"})
    EXPECT_FALSE(is_read(xml)) << xml;
}

}  // namespace sinew::xml_test
