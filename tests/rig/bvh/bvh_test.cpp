// SPDX-License-Identifier: GPL-3.0-or-later
// The contents of BVH files, in all the forms in which they occur.
#include <sinew/rig/bvh/bvh.h>

#include <gtest/gtest.h>

#include "rig/bvh/bvh_files.h"
#include "support/scratch.h"

namespace sinew::bvh_test {

using bvh_files::replaced;

Bvh parsed(const std::string& text) { return parse_bvh(text, "small.bvh"); }

TEST(Bvh, WithOneFrameMoreThanItAnnouncesIsReadWhole) {
  const std::string text = replaced(bvh_files::small, "Frames: 3", "Frames: 2");
  const Bvh bvh = parse_bvh(text, "a.bvh"), whole = parse_bvh(bvh_files::small, "a.bvh");
  EXPECT_EQ(bvh.frames, 3);
  EXPECT_EQ(bvh.values, whole.values);
  EXPECT_TRUE(whole.warnings.empty());
  const std::vector<std::string> warnings = {
      "a.bvh:26:1: one frame more than the 2 that are announced; it is read as well"};
  EXPECT_EQ(bvh.warnings, warnings);
  EXPECT_EQ(rig_of(bvh).warnings, warnings);
}

TEST(Bvh, ReadsTheFramesThatAreThereOfMoreAnnounced) {
  const Bvh all = parse_bvh(bvh_files::small, "a.bvh");
  const Bvh bvh = parse_bvh(replaced(bvh_files::small, "Frames: 3", "Frames: 5"), "a.bvh");
  EXPECT_EQ(bvh.frames, 3);
  EXPECT_EQ(bvh.values, all.values);
  ASSERT_EQ(bvh.warnings.size(), 1u);
  EXPECT_NE(bvh.warnings[0].find("after 3 of the 5 frames"), std::string::npos);
}

TEST(Bvh, HoldsWhatTheFileSays) {
  const Bvh bvh = parsed(bvh_files::small);
  ASSERT_EQ(bvh.joints.size(), 3u);
  const BvhJoint &hip = bvh.joints[0], &knee = bvh.joints[1], &foot = bvh.joints[2];
  EXPECT_EQ(hip.name + knee.name + foot.name, "hipkneefoot");
  EXPECT_EQ((std::vector{hip.parent, knee.parent, foot.parent}), (std::vector{no_bone, 0, 1}));
  EXPECT_EQ(hip.offset, Vec3(0, 1.5, 0.25));
  EXPECT_FALSE(knee.end.has_value());
  EXPECT_EQ(foot.end, Vec3(0, 0, 0.25));
  using enum BvhChannel;
  EXPECT_EQ(knee.channels, (std::vector{y_rotation, x_rotation, z_rotation}));
  EXPECT_EQ(foot.channels, (std::vector{x_rotation, y_position, z_rotation, y_rotation}));
  EXPECT_EQ(bvh.channels(), 13u);
  EXPECT_EQ(bvh.frames, 3);
  EXPECT_EQ(bvh.frame_time, 0.125);
  ASSERT_EQ(bvh.values.size(), 39u);
  EXPECT_EQ(bvh.values[13], 0.5);
  EXPECT_EQ(bvh.values.back(), 29);
}

TEST(Bvh, SpacesAndEndsOfLinesDoNotMatter) {
  const Bvh expected = parsed(bvh_files::small);
  const std::string& text = bvh_files::small;
  const std::string motion = text.substr(text.find("0.0 1.5 0.25 1.0"));
  const std::string head = text.substr(0, text.size() - motion.size());
  for (const std::string& variant :
       {replaced(text, "\n", "\r\n"), replaced(text, "\n", "\r"), replaced(text, "  ", "\t"),
        replaced(text, "\n", " \t\n\n"), replaced(text, "\n{", " {"),
        replaced(text, "\n    }", "}"), "\xEF\xBB\xBF" + text, "\n\n" + text + "\n \n\t",
        text.substr(0, text.size() - 1), head + replaced(motion, " ", "\n"),
        head + replaced(motion, "\n", " "), head + replaced(motion, " ", "\t"),
        replaced(text, "  OFFSET 0.0 -0.5 0.0\n", "  OFFSET\n0.0\n-0.5\n0.0\n"),
        replaced(text, "ROOT hip", "ROOT\n  hip"), replaced(text, "Frames: ", "Frames:"),
        replaced(text, "Frames: ", "Frames :\t"), replaced(text, "Time: ", "Time:"),
        replaced(text, "Frame Time: ", "Frame\tTime : ")})
    EXPECT_EQ(parsed(variant), expected) << variant;
}

TEST(Bvh, TheCaseOfKeywordsDoesNotMatter) {
  const Bvh expected = parsed(bvh_files::small);
  const std::pair<const char*, const char*> spellings[] = {
      {"HIERARCHY", "Hierarchy"}, {"ROOT", "Root"},
      {"JOINT", "joint"},         {"End Site", "END SITE"},
      {"End Site", "End site"},   {"OFFSET", "Offset"},
      {"CHANNELS", "channels"},   {"MOTION", "Motion"},
      {"Frames:", "FRAMES:"},     {"Frame Time:", "FRAME TIME:"},
      {"rotation", "Rotation"},   {"Xrotation", "xrotation"},
      {"Yposition", "YPOSITION"}, {"Frame Time", "frame time"}};
  for (const auto& [usual, other] : spellings) {
    ASSERT_TRUE(contains(bvh_files::small, usual));
    EXPECT_EQ(parsed(replaced(bvh_files::small, usual, other)), expected) << other;
  }
}

TEST(Bvh, NumbersMayBeWrittenInManyWays) {
  const Bvh expected = parsed(bvh_files::small);
  const std::string& text = bvh_files::small;
  const std::pair<const char*, const char*> spellings[] = {
      {"\n0.5 ", "\n+0.5 "},
      {"\n0.5 ", "\n.5 "},
      {"\n0.5 ", "\n5E-1 "},
      {"\n0.5 ", "\n0.05e+01 "},
      {".0", "."},
      {" -0.5 ", " -500e-3 "},
      {"0.125\n", "1.25e-1\n"},
      {" 3\n", " +3\n"},
      {"S 6", "S +6"},
      {".25", ".2500000000000000000000000000000"}};
  for (const auto& [usual, other] : spellings) {
    ASSERT_TRUE(contains(text, usual));
    EXPECT_EQ(parsed(replaced(text, usual, other)), expected) << other;
  }
  EXPECT_EQ(parsed(replaced(text, "\n0.5 ", "\n1e-999 ")).values[13], 0);
}

TEST(Bvh, NamesMayHoldSpacesColonsAndForeignLetters) {
  for (const std::string name : {"Left Hip", "mixamorig:Hips",
                                 "h\xC3\xBC"
                                 "fte",
                                 "1", "OFFSET", "", "\xE8\x85\xB0", "a-b_c.d|e", "hip # 1"}) {
    const std::string text = replaced(bvh_files::small, "ROOT hip", "ROOT " + name);
    EXPECT_EQ(parsed(text).joints[0].name, name);
    EXPECT_EQ(parsed(replaced(text, "\n{", "{")).joints[0].name, name);
  }
}

TEST(Bvh, JointsMayHaveFewOrNoChannels) {
  const std::string motion = "MOTION\nFrames: 2\nFrame Time: 1\n10\n20\n";
  for (const char* none : {"CHANNELS 0", ""}) {
    const Bvh bvh = parsed(bvh_files::arm(none, "CHANNELS 1 Xrotation", motion));
    EXPECT_TRUE(bvh.joints[0].channels.empty());
    EXPECT_EQ(bvh.values, (std::vector<double>{10, 20}));
  }
}

TEST(Bvh, TakesSeveralRoots) {
  const std::string second = "ROOT prop\n{\nOFFSET 1 2 3\nCHANNELS 1 Xrotation\n}\nMOTION";
  std::string text = replaced(bvh_files::small, "MOTION", second);
  for (const char* last : {" 9.0\n", " 19.0\n", " 29.0\n"})
    text = replaced(text, last, std::string(last) + "77\n");
  const Bvh bvh = parsed(text);
  ASSERT_EQ(bvh.joints.size(), 4u);
  EXPECT_EQ(bvh.joints[3].parent, no_bone);
  EXPECT_EQ(bvh.values[13], 77);
}

TEST(Bvh, TheFirstEndSiteOfAJointCountsBesideItsChildren) {
  const std::string ends =
      "  End Site\n{\nOFFSET 1 2 3\n}\nEnd Site\n{\nOFFSET 4 5 6\n}\n  JOINT knee";
  const Bvh bvh = parsed(replaced(bvh_files::small, "  JOINT knee", ends));
  EXPECT_EQ(bvh.joints[0].end, Vec3(1, 2, 3));
  EXPECT_EQ(bvh.joints.size(), 3u);
}

TEST(Bvh, EndSitesMayHaveANameAndNoChannels) {
  const Bvh expected = parsed(bvh_files::small);
  for (const auto& [usual, other] : {std::pair("End Site\n", "End Site rig:toe end\n"),
                                     {"End Site\n      {", "End Site toe {"},
                                     {"0.0 0.0 0.25\n", "0.0 0.0 0.25\n        CHANNELS 0\n"}})
    EXPECT_EQ(parsed(replaced(bvh_files::small, usual, other)), expected) << other;
}

TEST(Bvh, AHierarchyAloneIsASkeletonWithoutAClip) {
  const std::string& text = bvh_files::small;
  const Bvh bvh = parsed(text.substr(0, text.find("MOTION")));
  EXPECT_EQ(bvh.joints, parsed(text).joints);
  EXPECT_EQ(bvh.frames, 0);
  EXPECT_TRUE(rig_of(bvh).clips.empty());
  EXPECT_EQ(rig_of(bvh).skeleton.size(), 3u);
}

class BvhFile : public Scratch {};

TEST_F(BvhFile, IsReadAsItsText) {
  put(folder / "small.bvh", bvh_files::small);
  EXPECT_EQ(read_bvh(folder / "small.bvh"), parsed(bvh_files::small));
}

}  // namespace sinew::bvh_test
