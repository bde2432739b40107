// SPDX-License-Identifier: GPL-3.0-or-later
// Clips of other skeletons: names that agree by habit, rest poses that differ, sizes.
#include <gtest/gtest.h>

#include <sinew/rig/retarget.h>

#include "support/expect_error.h"

namespace sinew::retarget_test {

Skeleton joints(const std::vector<Joint>& joints) { return skeleton_of(joints); }

Skeleton named(const std::vector<std::string>& names) {
  std::vector<Joint> all;
  for (const std::string& name : names)
    all.push_back({name, static_cast<int>(all.size()) - 1, Vec3(0, all.size(), 0), {}});
  return skeleton_of(all);
}

void expect_matches(const std::vector<NamePair>& pairs) {
  std::vector<std::string> own, given;
  for (const NamePair& pair : pairs) own.push_back(pair[0]), given.insert(given.begin(), pair[1]);
  EXPECT_EQ(matched_names(named(own), named(given)), pairs);
}

TEST(MatchedNames, AgreeWhateverPrefixSideAndCase) {
  expect_matches({{"Hips", "mixamorig:Hips"},
                  {"Spine1", "mixamorig9:Spine1"},
                  {"LeftArm", "mixamorig:LeftArm"},
                  {"leg.r", "Armature_Leg_R"},
                  {"Finger1.L", "l_finger1"},
                  {"l", "L"}});
}

TEST(MatchedNames, AgreeByTheHabitsOfOtherPrograms) {
  expect_matches({{"mixamorig:Hips", "pelvis"},
                  {"mixamorig:LeftUpLeg", "thigh_l"},
                  {"mixamorig:RightLeg", "rShin"},
                  {"mixamorig:LeftArm", "J_Bip_L_UpperArm"},
                  {"mixamorig:RightForeArm", "lowerarm_r"},
                  {"mixamorig:LeftShoulder", "lCollar"},
                  {"mixamorig:RightToeBase", "ball_r"}});
  EXPECT_EQ(matched_names(named({"leg", "left"}), named({"right", "LeftLeg"})).size(), 0u);
  EXPECT_TRUE(are_same(matched_names(named({"leg", "arm"}), named({"arm", "leg"}))));
}

/// A trunk up, and an arm of two bones along `way`, with a root at `hips` of another size.
Skeleton figure(const Vec3& way, double size, const std::string& prefix) {
  const Vec3 hips(0, size, 0), chest(0, 1.5 * size, 0), elbow = chest + 0.3 * size * way;
  return joints(
      {{prefix + "Hips", no_bone, hips, {}},
       {prefix + "Spine", 0, chest, {}},
       {prefix + "LeftArm", 1, chest + 0.1 * size * Vec3::UnitX(), {}},
       {prefix + "LeftForeArm", 2, elbow + 0.1 * size * Vec3::UnitX(), {}},
       {prefix + "LeftHand", 3, elbow + 0.1 * size * Vec3::UnitX() + 0.3 * size * way, {}}});
}

/// The arm swings about z by 60 degrees as the hips walk.
Clip swing() {
  Clip clip;
  for (const int bone : {0, 2}) {
    Track& track = clip.motion.tracks.emplace_back();
    track.bone = bone;
    track.rotation.times = {0, 1};
    track.rotation.values = {Quat::Identity(),
                             Quat(Eigen::AngleAxisd(pi / 3 * bone / 2, Vec3::UnitZ()))};
  }
  clip.motion.tracks[0].translation.times = {0, 1};
  clip.motion.tracks[0].translation.values = {Vec3::Zero(), Vec3(0, 0, 2)};
  return clip;
}

TEST(Retargeted, BonesPointWhereThoseOfTheClipPointWhateverTheirRest) {
  const Skeleton from = figure(Vec3::UnitX(), 2, "mixamorig:");    // a T
  const Skeleton to = figure(Vec3(1, -1, 0).normalized(), 1, "");  // an A
  const Retargeted made = retargeted(from, swing(), to, matched_names(to, from));
  for (const double time : {0.0, 0.3, 1.0}) {
    const Pose own = pose_at(to, made.motion, time), given = pose_at(from, swing().motion, time);
    for (const int bone : {2, 3})
      EXPECT_LT((own[bone].axis() - given[bone].axis()).norm(), 1e-6) << bone << " at " << time;
    EXPECT_LT((own[0].frame.origin - Vec3(0, 1, time)).norm(), 1e-6) << "half the size";
    for (const int bone : {1, 3}) {
      const int parent = to.bones[bone].parent;
      EXPECT_NEAR((own[bone].frame.origin - own[parent].frame.origin).norm(),
                  (to.bones[bone].head() - to.bones[parent].head()).norm(), 1e-9);
    }
  }
  ASSERT_EQ(made.warnings.size(), 1u);
  EXPECT_NE(made.warnings[0].find(" by 45 degrees"), std::string::npos) << made.warnings[0];
}

TEST(Retargeted, AClipThatRestsAtTheOriginBeginsWhereTheBodyIs) {
  Skeleton from = figure(Vec3::UnitX(), 1, "");
  const Skeleton to = from;
  for (Bone& bone : from.bones) bone.rest.origin.y() -= 1;
  Clip clip = swing();
  for (Vec3& value : clip.motion.tracks[0].translation.values) value += Vec3(5, 1, 0);
  const Retargeted made = retargeted(from, clip, to, matched_names(to, from));
  EXPECT_LT((pose_at(to, made.motion, 1)[0].frame.origin - Vec3(0, 1, 2)).norm(), 1e-9);
}

TEST(Retargeted, TellsWhatDoesNotMatchAndRefusesWrongNames) {
  const Skeleton to = figure(Vec3::UnitX(), 1, ""), from = named({"Hips", "Tail"});
  const Retargeted made = retargeted(from, {}, to, {{"Hips", "Hips"}});
  ASSERT_EQ(made.warnings.size(), 2u);
  EXPECT_NE(made.warnings[0].find("leaves out 1 of 2 joints of the clip: 'Tail'"),
            std::string::npos);
  EXPECT_NE(made.warnings[1].find("4 of 5 bones: 'Spine'"), std::string::npos) << made.warnings[1];
  const auto refused = [&](const std::vector<NamePair>& names, const std::string& what) {
    test::expect_bad_input([&] { retargeted(from, {}, to, names); }, {what});
  };
  refused({{"Hip", "Hips"}}, "no bone 'Hip' in the skeleton");
  refused({{"Hips", "hips"}}, "no joint 'hips' in the clip");
  refused({{"Hips", "Hips"}, {"Hips", "Tail"}}, "'Hips' is given twice");
}

}  // namespace sinew::retarget_test
