// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/xml_bounds.h>

#include <gtest/gtest.h>

#include <string>

namespace sinew {
namespace {

std::string times(int count, const std::string& text) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

TEST(XmlBounds, OurFilesAreWithin) {
  EXPECT_TRUE(
      is_within_bounds("<?xml version=\"1.0\"?>\n<a b=\"1 > 0\">\n <c/>text &amp; more</a>\n"));
  EXPECT_TRUE(is_within_bounds("<a>" + times(100'000, "<b c='d'/>") + "</a>"));
  EXPECT_TRUE(is_within_bounds("<a>" + std::string(3'000'000, 'x') + "</a>"));
  EXPECT_TRUE(is_within_bounds("<a>" + times(20, "<b>") + times(20, "</b>") + "</a>"));
}

TEST(XmlBounds, DeepElementsAreNot) {
  EXPECT_FALSE(is_within_bounds(times(33, "<a>")));
  EXPECT_FALSE(is_within_bounds(times(33, "<a b='/'>")));
}

TEST(XmlBounds, WhatTheParserWouldLookAtAgainAndAgainIsNot) {
  const std::string endless(100'000, 'x');
  EXPECT_FALSE(is_within_bounds(endless));
  EXPECT_FALSE(is_within_bounds("<a/>" + endless));
  EXPECT_FALSE(is_within_bounds('<' + endless));
  EXPECT_FALSE(is_within_bounds("<a b=\"" + endless + "\"/>"));
  EXPECT_FALSE(is_within_bounds("<?" + endless + "?><a/>"));
  EXPECT_FALSE(is_within_bounds("<a>&" + endless + "</a>"));
}

TEST(XmlBounds, ElementsWithoutNumberAreNot) {
  EXPECT_FALSE(is_within_bounds("<a>" + times(200'000, "<b/>") + "</a>"));
}

TEST(XmlBounds, CommentsAndTypesAreNot) {
  EXPECT_FALSE(is_within_bounds("<a><!-- b --></a>"));
  EXPECT_FALSE(is_within_bounds("<a><![CDATA[b]]></a>"));
  EXPECT_FALSE(is_within_bounds("<!DOCTYPE a [<!ENTITY b 'c'>]><a>&b;</a>"));
}

}  // namespace
}  // namespace sinew
