// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/arrays.h>

#include <gtest/gtest.h>

#include <sinew/core/error.h>
#include <sinew/settings/table.h>

namespace sinew::requested_arrays_test {

using Names = std::vector<std::string_view>;

TEST(RequestedArrays, AreNamedWithCommasOrSpacesAndComeInTheOrderOfTheTable) {
  EXPECT_EQ(requested_arrays("stress, J").measured, (Names{"J", "stress"}));
  EXPECT_EQ(requested_arrays("  J\tJ stress,").measured, (Names{"J", "stress"}));
  EXPECT_EQ(requested_arrays("force_twist J bone_point").stepped,
            (Names{"bone_point", "force_twist"}));
  EXPECT_TRUE(requested_arrays("").measured.empty());
  EXPECT_FALSE(requested_arrays("J").all);
}

TEST(RequestedArrays, AreAllThereAreByOneWord) {
  const RequestedArrays all = requested_arrays("all");
  EXPECT_TRUE(all.all);
  EXPECT_EQ(all.measured.size(), measured_arrays().size());
  EXPECT_EQ(all.stepped.size(), stepped_arrays().size());
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
    for (const auto names : {measured_arrays(), stepped_arrays()})
      for (const std::string_view name : names)
        EXPECT_NE(row.help.find(name), std::string_view::npos) << name;
    return;
  }
  FAIL() << "output.arrays is no setting";
}

}  // namespace sinew::requested_arrays_test
