// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/json.h>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

namespace sinew::json_test {

std::string nested(int depth) {
  return std::string(static_cast<std::size_t>(depth), '[') +
         std::string(static_cast<std::size_t>(depth), ']');
}

TEST(JsonExtent, CountsBracketsOutsideOfStrings) {
  EXPECT_EQ(json_extent(R"({"a": [1, {"b": "]]{\"[["}], "c": 2})").depth, 3);
  EXPECT_EQ(json_extent(R"(["[", 1, 2])").values, 3);
  EXPECT_EQ(json_extent(nested(1000)).depth, 1000);
}

TEST(OwnJson, IsDiscardedWhereItIsDeepOrNone) {
  using Json = nlohmann::json;
  EXPECT_EQ(own_json<Json>("{\"a\": [1]}").at("a").at(0), 1);
  EXPECT_TRUE(own_json<Json>(nested(16)).is_array());
  for (const std::string& text : {nested(17), nested(200'000), std::string("{"), std::string()})
    EXPECT_TRUE(own_json<Json>(text).is_discarded());
}

}  // namespace sinew::json_test
