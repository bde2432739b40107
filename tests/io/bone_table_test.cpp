// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/bone_table.h>

#include <gtest/gtest.h>
#include <regex>

#include "support/scratch.h"

namespace sinew::bone_table_test {

using BoneTableFile = Scratch;

TEST_F(BoneTableFile, HasARowPerBoneAndFrame) {
  Skeleton skeleton;
  skeleton.bones.resize(2);
  skeleton.bones[0].name = "lower";
  skeleton.bones[1].name = "upper, \"left\"";
  const std::vector<BoneRow> sums = {{Vec3(1, 2, 3), Vec3(4, 5, 6), 7},
                                     {Vec3(0, 0, 0.5), Vec3(0, -1, 0), -0.25}};
  const std::vector<BoneRow> pins = {{Vec3(1, 0, 0), Vec3(0, 2, 0), 3},
                                     {Vec3(0, 4, 0), Vec3(0, 0, 5), 6}};
  const auto path = folder / "bones.csv";
  BoneTable table(path);
  table.add(0, skeleton, sums, {sums, pins, {}});
  table.add(0.5, skeleton, sums, {sums, pins, {}});
  table.close();
  const std::string part = "force_x,~force_y,~force_z,~moment_x,~moment_y,~moment_z,~power";
  std::string columns = "time,bone";
  for (const char* name : {"", "spring_", "pin_", "obstacle_"})
    columns += std::string(",") + name + std::regex_replace(part, std::regex("~"), name);
  const std::string lower = "1,2,3,4,5,6,7", upper = "0,0,0.5,0,-1,0,-0.25";
  const std::string rows[] = {
      "lower," + lower + ',' + lower + ",1,0,0,0,2,0,3,0,0,0,0,0,0,0\n",
      "\"upper, \"\"left\"\"\"," + upper + ',' + upper + ",0,4,0,0,0,5,6,0,0,0,0,0,0,0\n"};
  EXPECT_EQ(read_file(path),
            columns + "\n0," + rows[0] + "0," + rows[1] + "0.5," + rows[0] + "0.5," + rows[1]);
}

TEST_F(BoneTableFile, WritesNoNameThatASpreadsheetComputes) {
  Skeleton skeleton;
  const std::vector<BoneRow> some(1, {Vec3::Zero(), Vec3::Zero(), 0});
  const auto cell = [&](const std::string& name) {
    skeleton.bones.assign(1, {});
    skeleton.bones[0].name = name;
    BoneTable(folder / "bones.csv").add(0, skeleton, some, {some, {}, {}});
    const std::string text = text_of(folder / "bones.csv"),
                      row = text.substr(text.find("\n0,") + 3);
    return row.substr(0, row.find(",0,0,"));
  };
  EXPECT_EQ(cell("=1+1"), "'=1+1");
  EXPECT_EQ(cell("@SUM(A1,B1)"), "\"'@SUM(A1,B1)\"");
  EXPECT_EQ(cell("+1"), "'+1");
  EXPECT_EQ(cell("-1"), "'-1");
  EXPECT_EQ(cell("'=1+1"), "''=1+1");  // so that one off gives the name again
  EXPECT_EQ(cell("arm=1"), "arm=1");
}

TEST_F(BoneTableFile, GoesOnAfterTheFramesThatAreKept) {
  Skeleton skeleton;
  skeleton.bones.resize(2);
  skeleton.bones[0].name = "lower";
  skeleton.bones[1].name = "name of\ntwo lines, \"quoted\"";
  const std::vector<BoneRow> some = {{Vec3(1, 2, 3), Vec3(1, 2, 3), 7},
                                     {Vec3(0, 0, 0.5), Vec3(0, 0, 0.5), -0.25}};
  const auto write = [&](const char* name, std::size_t kept, std::initializer_list<double> times) {
    BoneTable table(folder / name, 2, kept);
    for (const double time : times) table.add(time, skeleton, some, {some, {}, {}});
  };
  write("whole.csv", 0, {0, 0.5, 1});
  write("bones.csv", 0, {0, 0.25});  // and is dropped, not closed
  put(folder / "bones.csv", text_of(folder / "bones.csv") + "0.5,lower,torn");
  write("bones.csv", 1, {0.5, 1});
  EXPECT_EQ(text_of(folder / "bones.csv"), text_of(folder / "whole.csv"));
  const Error error = error_of([&] { BoneTable(folder / "bones.csv", 2, 4); });
  EXPECT_EQ(error.exit(), Exit::bad_input);
  EXPECT_TRUE(contains(error.what(), "7 lines where 9")) << error.what();
}

}  // namespace sinew::bone_table_test
