// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/report/base64.h>

#include <gtest/gtest.h>

namespace sinew::test {
namespace {

std::string encoded(const std::string& text) {
  return base64(std::vector<std::uint8_t>(text.begin(), text.end()));
}

TEST(Base64, GivesTheTestVectorsOfRfc4648) {
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
}

TEST(Base64, WritesTheLowestByteOfANumberFirst) {
  EXPECT_EQ(base64_of(std::vector<std::uint16_t>{0x0201, 0x0403}), "AQIDBA==");
  EXPECT_EQ(base64_of(std::vector<std::int16_t>{-1}), "//8=");
}

}  // namespace
}  // namespace sinew::test
