// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/rig/front.h>

#include <gtest/gtest.h>
#include <vector>

namespace sinew::front_test {

/// A figure that looks along -y: its left is at +x. Turned about z by `angle`, rad.
std::optional<Vec3> front(const std::vector<std::string>& names, double angle) {
  const Points at = {{0, 0, 1}, {0.2, 0, 1.4}, {-0.2, 0, 1.4}, {0.1, 0, 0.1}, {-0.1, 0, 0.1}};
  const Points to = {{0, 0, 1.5}, {0.6, 0, 1.4}, {-0.6, 0, 1.4}, {0.1, -0.2, 0}, {-0.1, -0.2, 0}};
  const auto turned = [&](Points points) {
    for (Vec3& p : points) p = Eigen::AngleAxisd(angle, Vec3::UnitZ()) * p;
    return points;
  };
  return front_of(names, turned(at), turned(to));
}

TEST(Front, IsWhereAFigureLooksHoweverItsBonesAreNamed) {
  const std::vector<std::vector<std::string>> figures = {
      {"Hips", "LeftArm", "RightArm", "LeftFoot", "RightFoot"},
      {"mixamorig:Hips", "mixamorig:LeftArm", "mixamorig:RightArm", "a", "b"},
      {"Bip01", "Bip01 L UpperArm", "Bip01 R UpperArm", "Bip01 L Foot", "Bip01 R Foot"},
      {"root", "upperarm.L", "upperarm.R", "thigh.L", "thigh.R"},
      {"hip", "lShldr", "rShldr", "lThigh", "rThigh"},
      {"Skeleton_torso", "arm_joint_L__4_", "arm_joint_R__2_", "leg_joint_L_5", "leg_joint_R_5"},
      {"J_Bip_C_Hips", "J_Bip_L_UpperArm", "J_Bip_R_UpperArm", "x", "y"},
      {"trunk", "a", "b", "foot one", "foot two"}};
  for (const auto& names : figures)
    for (const double angle : {0.0, 1.0, -2.5}) {
      const auto found = front(names, angle);
      ASSERT_TRUE(found) << names[1];
      const Vec3 expected = Eigen::AngleAxisd(angle, Vec3::UnitZ()) * Vec3(-Vec3::UnitY());
      EXPECT_LT((*found - expected).norm(), 1e-9) << names[1];
    }
}

TEST(Front, IsToldByFeetWhereSidesAreNamedAsTheViewerSeesThem) {
  const auto found = front({"Hips", "RightArm", "LeftArm", "RightFoot", "LeftFoot"}, 0);
  ASSERT_TRUE(found);
  EXPECT_LT((*found + Vec3::UnitY()).norm(), 1e-9);
}

TEST(Front, IsUnknownWithoutSidesAndFeet) {
  EXPECT_FALSE(front({"lower", "upper", "ring", "girl", "rill"}, 0));
}

}  // namespace sinew::front_test
