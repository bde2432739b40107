// SPDX-License-Identifier: GPL-3.0-or-later
// The clips of data/motions move the bones as the scenes they were made from do.
#include <gtest/gtest.h>
#include <map>
#include <string>

#include <sinew/rig/bvh/bvh.h>
#include <sinew/rig/motion.h>
#include <sinew/scene/rig.h>
#include <sinew/scene/scene_files.h>
#include <sinew/settings/read_scene.h>
#include "support/source_dir.h"

namespace sinew::scene_test {

const std::string source = test::source_dir();

std::map<std::string, RigidFrame> frames_of(const Skeleton& skeleton, const Pose& pose) {
  std::map<std::string, RigidFrame> frames;
  for (std::size_t i = 0; i < skeleton.size(); ++i) frames[skeleton.bones[i].name] = pose[i].frame;
  return frames;
}

void expect_same_motion(const std::string& scene, const std::string& file) {
  const Settings settings = read_scene(source + "/configs/" + scene);
  const Skeleton skeleton = skeleton_of(settings);
  const Motion motion = motion_of(settings, skeleton);
  const Rig rig = rig_of(read_bvh(source + "/data/motions/" + file));
  const Clip& clip = rig.clips.at(0);
  EXPECT_EQ(rig.skeleton.size(), skeleton.size());
  for (int i = 0; i < clip.frames; ++i) {
    const double time = i * clip.frame_time;
    const auto expected = frames_of(skeleton, pose_at(skeleton, motion, time));
    for (const auto& [name, frame] :
         frames_of(rig.skeleton, pose_at(rig.skeleton, clip.motion, time))) {
      ASSERT_TRUE(expected.contains(name)) << name;
      EXPECT_LT((frame.origin - expected.at(name).origin).norm(), 1e-6) << name << ", frame " << i;
      EXPECT_LT((frame.rotation - expected.at(name).rotation).norm(), 1e-6) << name << ", " << i;
    }
  }
}

void expect_same_bones(const std::string& scene, const std::string& file) {
  const Skeleton skeleton = skeleton_of(read_scene(source + "/configs/" + scene));
  for (const Bone& bone : rig_of(read_bvh(source + "/data/motions/" + file)).skeleton.bones)
    for (const Bone& other : skeleton.bones) {
      if (bone.name != other.name) continue;
      EXPECT_LT((bone.head() - other.head()).norm(), 1e-9) << bone.name;
      EXPECT_LT((bone.tail() - other.tail()).norm(), 1e-9) << bone.name;
    }
}

TEST(BvhScene, BoxBendMovesAsItsScene) {
  expect_same_bones("box_bend.yaml", "box_bend.bvh");
  expect_same_motion("box_bend.yaml", "box_bend.bvh");
}

TEST(BvhScene, TheWalkMovesAsItsScene) {
  expect_same_bones("creature_walk.yaml", "walk.bvh");
  expect_same_motion("creature_walk.yaml", "walk.bvh");
}

TEST(BvhScene, AnotherFilesClipStartsFromTheSameRestPoseOfAClip) {
  Settings settings;
  settings.skeleton.file = source + "/data/motions/walk.bvh";
  settings.skeleton.rest_at = 0.5;
  settings.motion.preroll = 0;
  const SceneRig own = rig_of(settings, read_rig_files(settings));
  settings.motion.file = settings.skeleton.file;
  const SceneRig other = rig_of(settings, read_rig_files(settings));
  for (const double time : {0.0, 0.3, 0.5, 1.2}) {
    const Pose a = pose_at(own.skeleton, own.motion, time);
    const Pose b = pose_at(other.skeleton, other.motion, time);
    for (std::size_t bone = 0; bone < a.size(); ++bone) {
      EXPECT_LT((a[bone].frame.origin - b[bone].frame.origin).norm(), 1e-12);
      const double turned = (a[bone].turn - Mat3::Identity()).norm();
      EXPECT_TRUE(time != 0.5 || turned < 1e-9) << turned;
    }
  }
}

}  // namespace sinew::scene_test
