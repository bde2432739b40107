// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/arrays.h>

#include <gtest/gtest.h>
#include <algorithm>

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

TEST(SkinArrays, AreUsualOnesAndThoseThatAreNamed) {
  const SkinArrays unasked = skin_arrays("");
  EXPECT_TRUE(unasked.usual);
  EXPECT_TRUE(unasked.frame.empty() && unasked.requested.measured.empty());
  const SkinArrays named = skin_arrays("none, stress velocity, force_twist J");
  EXPECT_FALSE(named.usual);
  EXPECT_EQ(named.frame, Names{"velocity"});
  EXPECT_EQ(named.requested.measured, (Names{"J", "stress"}));
  EXPECT_EQ(named.requested.stepped, Names{"force_twist"});
  EXPECT_TRUE(named.contact.empty());
  EXPECT_EQ(skin_arrays("contact_area J").contact, Names{"contact_area"});
  EXPECT_TRUE(skin_arrays("displacement, bone").frame.empty());  // the surface has its own
}

TEST(SkinArrays, AreAllByOneWordButThoseThatTheSurfaceHasOfItsOwn) {
  const SkinArrays all = skin_arrays("all");
  for (const char* own : {"displacement", "bone"})
    EXPECT_EQ(std::count(all.frame.begin(), all.frame.end(), own), 0) << own;
  for (const char* name : {"id", "velocity", "force", "broken_bonds"})
    EXPECT_EQ(std::count(all.frame.begin(), all.frame.end(), name), 1) << name;
  EXPECT_EQ(all.requested.measured.size(), measured_arrays().size());
  EXPECT_EQ(all.requested.stepped.size(), stepped_arrays().size());
  EXPECT_EQ(all.contact, (Names{"contact_pressure", "contact_area"}));
}

TEST(SkinArrays, RefuseOtherNamesAndSuggestTheNearest) {
  try {
    skin_arrays("velocty");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.exit(), Exit::bad_input);
    EXPECT_NE(std::string(error.what()).find("did you mean velocity?"), std::string::npos)
        << error.what();
  }
}

TEST(SkinArrays, HaveTheUnitsAndComponentsOfTheParticles) {
  for (const std::string_view name : skin_arrays("all").frame) {
    const WrittenArray* row = find_written("surface", ArrayPlace::point, name);
    ASSERT_TRUE(row) << name;
    EXPECT_EQ(row->unit, find_written("particles", ArrayPlace::point, name)->unit);
  }
  EXPECT_EQ(find_written("surface", ArrayPlace::point, "stress")->components.size(), 6U);
  EXPECT_EQ(find_written("surface", ArrayPlace::point, "von_mises")->unit, "Pa");
  EXPECT_EQ(find_written("skin_lbs", ArrayPlace::point, "velocity"), nullptr);
  EXPECT_EQ(find_written("surface", ArrayPlace::field, "kinetic_energy"), nullptr);
}

}  // namespace sinew::requested_arrays_test
