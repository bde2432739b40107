// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/bone_table.h"

#include <gtest/gtest.h>

#include "scratch.h"

namespace sinew {
namespace {

using BoneTableFile = Scratch;

TEST_F(BoneTableFile, HasARowPerBoneAndFrame) {
  Skeleton skeleton;
  skeleton.bones.resize(2);
  skeleton.bones[0].name = "lower";
  skeleton.bones[1].name = "upper, \"left\"";
  const Points force = {{1, 2, 3}, {0, 0, 0.5}}, moment = {{4, 5, 6}, {0, -1, 0}};
  const std::vector<double> power = {7, -0.25};
  const auto path = folder / "bones.csv";
  BoneTable table(path);
  table.add(0, skeleton, {force, moment}, power);
  table.add(0.5, skeleton, {force, moment}, power);
  EXPECT_FALSE(std::filesystem::exists(path));
  table.close();
  const std::string rows[] = {"lower,1,2,3,4,5,6,7\n",
                              "\"upper, \"\"left\"\"\",0,0,0.5,0,-1,0,-0.25\n"};
  EXPECT_EQ(read_file(path),
            "time,bone,force_x,force_y,force_z,moment_x,moment_y,moment_z,power\n0," + rows[0] +
                "0," + rows[1] + "0.5," + rows[0] + "0.5," + rows[1]);
}

}  // namespace
}  // namespace sinew
