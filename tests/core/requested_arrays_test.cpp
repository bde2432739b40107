// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/arrays.h>

#include <gtest/gtest.h>

#include <sinew/core/error.h>
#include <sinew/settings/table.h>

namespace sinew::requested_arrays_test {

using Names = std::vector<std::string_view>;

TEST(RequestedArrays, AreNamedWithCommasOrSpacesAndComeInTheOrderOfTheTable) {
  EXPECT_EQ(requested_arrays("stress, J"), (Names{"J", "stress"}));
  EXPECT_EQ(requested_arrays("  J\tJ stress,"), (Names{"J", "stress"}));
  EXPECT_EQ(requested_arrays("all").size(), requestable_arrays().size());
  EXPECT_TRUE(requested_arrays("").empty());
}

TEST(RequestedArrays, RefuseOtherNamesAndSuggestTheNearest) {
  try {
    requested_arrays("J, stres");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.exit(), Exit::bad_input);
    EXPECT_NE(std::string(error.what()).find("did you mean stress?"), std::string::npos)
        << error.what();
  }
}

TEST(RequestedArrays, AreAllNamedByTheHelpOfTheSetting) {
  for (const auto& row : settings_table()) {
    if (row.section != "output" || row.name != "arrays") continue;
    for (const std::string_view name : requestable_arrays())
      EXPECT_NE(row.help.find(name), std::string_view::npos) << name;
    return;
  }
  FAIL() << "output.arrays is no setting";
}

}  // namespace sinew::requested_arrays_test
