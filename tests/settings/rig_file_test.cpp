// SPDX-License-Identifier: GPL-3.0-or-later
// A rig and a clip in YAML files of their own.
#include <gtest/gtest.h>

#include <sinew/rig/motion.h>
#include <sinew/scene/rig.h>
#include <sinew/settings/read_scene.h>
#include <sinew/settings/text_file.h>
#include <sinew/settings/write_scene.h>

#include "support/temp_folder.h"

namespace sinew::rig_file_test {

const std::string body = "body:\n  mesh: box.obj\n  radius: 0.01\n";
const std::string scene = body + "skeleton:\n  file: rigs/rig.yaml\nmotion:\n  file: clip.yml\n";
const std::string rig =
    "bones:\n"
    "  - name: lower\n"
    "    head: [0, 0, 0]\n"
    "    tail: [0, 0, 1]\n"
    "    limits: {swing: 80, twist: [-90, 45]}\n"
    "  - {name: upper, parent: lower, length: 2, roll: 30}\n";
const std::string clip =
    "frame_rate: 25\n"
    "tracks:\n"
    "  - bone: upper\n"
    "    interpolation: cubic\n"
    "    keys:\n"
    "      - {frame: 0, quaternion: [1, 0, 0, 0]}\n"
    "      - {frame: 50, axis: [0, 1, 0], angle: 270, stretch: 1.5}\n";

class RigFile : public testing::Test {
 protected:
  RigFile() {
    std::filesystem::create_directory(folder_.path() / "rigs");
    write("rigs/rig.yaml", rig);
    write("clip.yml", clip);
    write("scene.yaml", scene);
  }

  void write(const std::string& name, const std::string& text) { folder_.write(name, text); }
  std::filesystem::path at(const std::string& name) const { return folder_.path() / name; }
  Settings read(std::vector<Override> overrides = {}) {
    return read_scene(at("scene.yaml"), overrides);
  }
  /// The message of reading the scene and making its motion.
  std::string message() {
    try {
      const Settings settings = read();
      motion_of(settings, skeleton_of(settings));
    } catch (const Error& error) {
      EXPECT_EQ(error.exit(), Exit::bad_input);
      return error.what();
    }
    return "";
  }
  void expect_message(const std::string& begin, const std::string& part) {
    const std::string said = message();
    EXPECT_EQ(said.substr(0, begin.size()), begin);
    EXPECT_NE(said.find(part), said.npos) << said;
  }

  TempFolder folder_;
};

TEST_F(RigFile, HoldsBonesAndTracks) {
  const Settings settings = read();
  const Skeleton skeleton = skeleton_of(settings);
  ASSERT_EQ(skeleton.size(), 2u);
  EXPECT_EQ(skeleton.bones[1].tail(), Vec3(0, 0, 3));
  EXPECT_NEAR(skeleton.bones[0].limits.max_twist, radians(45), 1e-15);
  const Motion motion = motion_of(settings, skeleton);
  ASSERT_EQ(motion.tracks.size(), 1u);
  EXPECT_EQ(last_key(motion), 2);
  EXPECT_NEAR(motion.tracks[0].rotation.turns[1].y(), radians(270), 1e-12);
}

TEST_F(RigFile, ResolvedSceneHoldsAllOfIt) {
  const Settings settings = read();
  const std::string text = resolved_scene(settings, folder_.path());
  std::filesystem::remove(at("rigs/rig.yaml"));
  std::filesystem::remove(at("clip.yml"));
  write("scene.yaml", text);
  const Settings again = read();
  EXPECT_EQ(resolved_scene(again, folder_.path()), text);
  const Skeleton one = skeleton_of(settings), two = skeleton_of(again);
  for (const double time : {0.0, 0.7, 1.3, 4.0}) {
    const Pose a = pose_at(one, motion_of(settings, one), time);
    const Pose b = pose_at(two, motion_of(again, two), time);
    EXPECT_EQ(a[1].frame.rotation, b[1].frame.rotation);
    EXPECT_EQ(a[1].stretch, b[1].stretch);
  }
}

TEST_F(RigFile, MistakesNameItsOwnLine) {
  const std::string rig_name = seen_from("", at("rigs/rig.yaml")).string();
  const std::string clip_name = seen_from("", at("clip.yml")).string();
  write("rigs/rig.yaml", rig + "    rol: 3\n");
  expect_message(rig_name + ":", "");
  write("rigs/rig.yaml", rig + "  - {name: tip, parent: uper, length: 1}\n");
  expect_message(rig_name + ":7:25: ", "'uper'");
  write("rigs/rig.yaml", rig + "solver: {}\n");
  expect_message(rig_name + ":7:1: ", "unknown key 'solver'");
  write("rigs/rig.yaml", "");
  expect_message(rig_name + ": ", "nothing in this file");
  write("rigs/rig.yaml", rig);
  write("clip.yml", clip + "      - {frame: 50}\n");
  expect_message(clip_name + ":8:17: ", "ascending");
  write("clip.yml", clip.substr(clip.find("tracks")));
  expect_message(clip_name + ":5:17: ", "frame_rate");
}

TEST_F(RigFile, ThatIsMissingNamesTheScenesLine) {
  std::filesystem::remove(at("rigs/rig.yaml"));
  expect_message(at("scene.yaml").string() + ":5:9: ", "rig.yaml");
}

TEST_F(RigFile, StandsInPlaceOfTheList) {
  write("scene.yaml", body + "skeleton:\n  file: rigs/rig.yaml\n" + "  " + "bones: []\n");
  expect_message(at("scene.yaml").string() + ":5:9: ", "both given");
  write("scene.yaml", scene + "  tracks: [{bone: upper, keys: [{time: 0}]}]\n");
  expect_message(at("scene.yaml").string() + ":7:9: ", "both given");
}

TEST_F(RigFile, OfAnotherKindIsKeptForItsReader) {
  write("scene.yaml", body +
                          "skeleton: {file: rigs/fox.glb, up: y, scale: 0.01}\n"
                          "motion: {file: walk.bvh, clip: walk, positions: add}\n");
  const Settings settings = read();
  EXPECT_TRUE(settings.bones.empty());
  EXPECT_TRUE(std::filesystem::path(settings.skeleton.file).filename() == "fox.glb");
  write("scene.yaml", resolved_scene(settings, folder_.path()));
  const Settings again = read();
  EXPECT_EQ(again.skeleton.file, settings.skeleton.file);
  EXPECT_EQ(again.motion.file, settings.motion.file);
  EXPECT_EQ(again.motion.clip, "walk");
  EXPECT_EQ(again.motion.positions, Positions::add);
}

TEST_F(RigFile, ScenesOwnFrameRateGoesFirst) {
  const Settings settings = read({parse_override("motion.frame_rate=50")});
  EXPECT_EQ(last_key(motion_of(settings, skeleton_of(settings))), 1);
}

TEST_F(RigFile, RefusesUpAlongForwardAndAnEndBeforeTheStart) {
  write("scene.yaml", body + "skeleton: {file: rigs/rig.yaml, up: y, forward: -y}\n");
  expect_message(at("scene.yaml").string() + ":4:49: ", "one axis");
  write("scene.yaml", scene + "  start: 2\n  end: 1\n");
  expect_message(at("scene.yaml").string() + ":9:8: ", "before it begins");
}

}  // namespace sinew::rig_file_test
