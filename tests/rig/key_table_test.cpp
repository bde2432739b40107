// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <random>

#include <sinew/rig/key_table.h>

#include "support/expect_error.h"

namespace sinew {
namespace {

const std::string header = "time,bone,qw,qx,qy,qz,tx,ty,tz\n";

TEST(KeyTables, ReadTheNumbersThatWereWritten) {
  std::mt19937 random(3);
  std::normal_distribution<double> any;
  for (const bool twist : {false, true}) {
    std::string text = key_table_header(twist);
    std::vector<KeyDefinition> written;
    for (int k = 0; k < 50; ++k) {
      const Quat q = Quat(any(random), any(random), any(random), any(random)).normalized();
      KeyDefinition key;
      key.time = k / 60.0;
      key.quaternion = {q.w(), q.x(), q.y(), q.z()};
      key.translation = {any(random), 1e-9 * any(random), 1e9 * any(random)};
      if (twist) key.twist = any(random);
      text += key_row("a \"bone\", of two", key, twist);
      written.push_back(key);
    }
    const auto tracks = tracks_of_keys(text + "0.9,torn", "a.csv");
    ASSERT_EQ(tracks.size(), 1u);
    EXPECT_EQ(tracks[0].bone, "a \"bone\", of two");
    EXPECT_EQ(tracks[0].interpolation, Interpolation::linear);
    ASSERT_EQ(tracks[0].keys.size(), written.size());
    for (std::size_t k = 0; k < written.size(); ++k) {
      EXPECT_EQ(tracks[0].keys[k].time, written[k].time);
      EXPECT_EQ(tracks[0].keys[k].quaternion, written[k].quaternion);
      EXPECT_EQ(tracks[0].keys[k].translation, written[k].translation);
      EXPECT_EQ(tracks[0].keys[k].twist, written[k].twist);
    }
  }
}

TEST(KeyTables, AreRefusedWithTheirLine) {
  const auto refused = [](const std::string& text, const std::string& words) {
    test::expect_bad_input([&] { tracks_of_keys(text, "a.csv"); }, {words});
  };
  refused("", "a.csv:1: this is no table of keys");
  refused("a,b\n1,2\n", "a.csv:1: this is no table of keys");
  refused(header + "0,a,1,0,0,0,0,0,0\n0,a,1,0,0,0,0,0,0\n", "a.csv:3: keys of 'a' are not in");
  refused(header + "0,a,1,0,0,0,0,0\n", "a.csv:2: a row of 8 cells");
  refused(header + "x,a,1,0,0,0,0,0,0\n", "a.csv:2: time is 'x', which is no number");
  refused(header + "0,a,1,0,0,nan,0,0,0\n", "a.csv:2: qz is 'nan', which is no number");
  refused(header + "0,a,2,0,0,0,0,0,0\n", "a.csv:2: a quaternion of length 2");
  EXPECT_TRUE(tracks_of_keys(header, "a.csv").empty());
  EXPECT_EQ(tracks_of_keys("time,bone,qw,qx,qy,qz,tx,ty,tz\r\n0,a,1,0,0,0,0,0,0\r\n", "a").size(),
            1u);
}

}  // namespace
}  // namespace sinew
