// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <sinew/settings/read_scene.h>
#include <sinew/settings/sections.h>
#include <sinew/settings/write_scene.h>

#include "settings/small_scene.h"
#include "support/expect_error.h"
#include "support/temp_folder.h"

namespace sinew::world_test {

// Begins in line 9 of the scene.
const std::string everything = R"(world:
  drag: 0.5
  obstacles:
    - name: floor
      shape: plane
      friction: 0.4
      friction_keys:
        - time: 0
          factor: 1
        - time: 2
          factor: 0
    - name: ball
      shape: sphere
      center: [0, 0, 1]
      radius: 0.1
      stiffness: 2
      keys:
        - time: 0
        - time: 1/2
          translation: [0, 0, -0.1]
          axis: [0, 1, 0]
          angle: 720
    - name: rod
      shape: capsule
      from: [0, 0, 0]
      to: [1, 0, 0]
      radius: 0.05
      bone: lower
    - name: block
      shape: box
      center: [1, 2, 3]
      size: [1, 1, 2]
      rotation: [0, 45, 0]
      damping: 0
    - name: hand
      shape: mesh
      mesh: hand.obj
  pins:
    - low: [0, 0, 0]
      high: [1, 1, 0.1]
    - center: [0, 0, 1]
      radius: 0.2
      bone: lower
  fields:
    - name: wind
      acceleration: [3, 0, 0]
      low: [0, 0, 0]
      high: [1, 1, 1]
      falloff: 0.1
      keys:
        - time: 0
          strength: 0
        - time: 1
          strength: -2
    - {name: lift, shape: density, density: [0, 0, 2000]}
    - {name: well, shape: attraction, point: [0, 0, 1], strength: -4, core: 0.1}
    - {name: whirl, shape: swirl, point: [1, 0, 0], axis: [0, 0, 2], strength: 5, core: 0.2}
  muscles:
    - name: biceps
      bone: lower
      strength: 20000
      keys:
        - time: 0.2
          activation: 1
)";

Settings read(const std::string& world) {
  const TempFolder folder;
  return read_scene(folder.write("scene.yaml", small_scene + world));
}

TEST(WorldSection, IsRead) {
  const TempFolder folder;
  const WorldSettings world =
      read_scene(folder.write("scene.yaml", small_scene + everything)).world;
  EXPECT_EQ(world.drag, 0.5);
  ASSERT_EQ(world.obstacles.size(), 5U);
  EXPECT_EQ(world.obstacles[0].friction, 0.4);
  EXPECT_EQ(world.obstacles[0].friction_keys.size(), 2u);
  EXPECT_EQ(world.obstacles[0].friction_keys.back().time, 2);
  EXPECT_EQ(world.obstacles[1].stiffness, 2);
  ASSERT_EQ(world.obstacles[1].keys.size(), 2U);
  EXPECT_EQ(world.obstacles[1].keys[1].time, 0.5);
  EXPECT_EQ(world.obstacles[1].keys[1].angle, 720);
  EXPECT_EQ(world.obstacles[2].bone, "lower");
  EXPECT_EQ(world.obstacles[3].rotation, Vec3(0, 45, 0));
  const auto mesh = std::filesystem::absolute(world.obstacles[4].mesh).lexically_normal();
  EXPECT_EQ(mesh, folder.path() / "hand.obj");
  ASSERT_EQ(world.pins.size(), 2U);
  EXPECT_EQ(world.pins[0].region.high, Vec3(1, 1, 0.1));
  EXPECT_EQ(world.pins[1].region.radius, 0.2);
  ASSERT_EQ(world.fields.size(), 4U);
  EXPECT_EQ(world.fields[0].keys[1].value, -2);
  EXPECT_EQ(world.fields[1].density, Vec3(0, 0, 2000));
  EXPECT_EQ(world.fields[2].strength, -4);
  EXPECT_EQ(world.fields[3].shape, FieldShape::swirl);
  EXPECT_EQ(world.fields[3].axis, Vec3(0, 0, 2));
  ASSERT_EQ(world.muscles.size(), 1U);
  EXPECT_EQ(world.muscles[0].keys[0].time, 0.2);
  EXPECT_FALSE(world.empty());
}

TEST(WorldSection, MayBeMissing) {
  EXPECT_TRUE(read("").world.empty());
  EXPECT_TRUE(read("world:\n").world.empty());
  EXPECT_TRUE(read("world:\n  drag: 0\n  obstacles: []\n  pins: []\n").world.empty());
}

TEST(WorldSection, ReadsBackAsTheSameScene) {
  const TempFolder folder;
  const Settings settings = read_scene(folder.write("a.yaml", small_scene + everything));
  const std::string once = resolved_scene(settings, folder.path() / "out");
  EXPECT_NE(once.find("mesh: ../hand.obj"), once.npos);
  const Settings again = read_scene(folder.write("out/scene.yaml", once));
  EXPECT_EQ(resolved_scene(again, folder.path() / "out"), once);
  EXPECT_EQ(again.world.obstacles.size(), 5U);
  EXPECT_EQ(again.world.obstacles[1].keys[1].translation, Vec3(0, 0, -0.1));
  EXPECT_EQ(again.world.fields[0].keys[1].value, -2);
  EXPECT_EQ(again.world.muscles[0].strength, 20000);
}

struct Mistake {
  std::string lines, message;
};

class WorldMistakes : public testing::TestWithParam<Mistake> {};

TEST_P(WorldMistakes, NameTheLineAndTheCure) {
  test::expect_bad_input([] { read("world:\n" + GetParam().lines); }, {GetParam().message});
}

INSTANTIATE_TEST_SUITE_P(
    All, WorldMistakes,
    testing::Values(
        Mistake{"  obstacle: []\n", "scene.yaml:10:3: unknown key 'obstacle' in world"},
        Mistake{"  obstacles:\n    - shape: plane\n", ":11:7: world.obstacles[0].name is missing"},
        Mistake{"  obstacles:\n    - name: a\n", ":11:7: world.obstacles[0].shape is missing"},
        Mistake{"  obstacles:\n    - {name: a, shape: cube}\n", "'cube'"},
        Mistake{"  obstacles:\n    - {name: a, shape: sphere, center: [0, 0, 0]}\n",
                ":11:7: world.obstacles[0].radius is missing, which a sphere needs"},
        Mistake{"  obstacles:\n    - {name: a, shape: capsule, from: [0, 0, 0], radius: 1}\n",
                "world.obstacles[0].to is missing"},
        Mistake{"  obstacles:\n    - {name: a, shape: box, size: [1, 1, 1]}\n",
                "world.obstacles[0].center is missing"},
        Mistake{"  obstacles:\n    - {name: a, shape: box, center: [0, 0, 0], size: [1, 0, 1]}\n",
                "a box without size along an axis"},
        Mistake{"  obstacles:\n    - {name: a, shape: mesh}\n", "mesh is missing"},
        Mistake{"  obstacles:\n    - {name: a, shape: plane, normal: [0, 0, 0]}\n",
                "a direction without length"},
        Mistake{"  obstacles:\n    - {name: a, shape: plane}\n    - {name: a, shape: plane}\n",
                ":12:14: two of world.obstacles are named 'a'"},
        Mistake{"  obstacles:\n    - name: a\n      shape: plane\n      bone: lower\n"
                "      keys: [{time: 0}]\n",
                ":14:13: world.obstacles[0] has a bone and keys of its own"},
        Mistake{"  obstacles:\n    - name: a\n      shape: plane\n"
                "      keys: [{time: 1}, {time: 1}]\n",
                ":13:32: keys are not in ascending time"},
        Mistake{"  obstacles:\n    - name: a\n      shape: plane\n      friction_keys: [{time: 0, "
                "factor: "
                "1}]\n",
                ":13:22: world.obstacles[0] has factors on a friction of 0"},
        Mistake{"  pins:\n    - bone: lower\n", ":11:7: world.pins[0] has no region"},
        Mistake{"  pins:\n    - low: [0, 0, 0]\n", "world.pins[0] has one corner of a box"},
        Mistake{"  pins:\n    - radius: 2\n", "world.pins[0] has half of a ball"},
        Mistake{"  pins:\n    - {low: [0, 0, 0], high: [1, 0, 1]}\n", "is not below high"},
        Mistake{"  pins:\n    - {low: [0, 0, 0], high: [1, 1, 1], center: [0, 0, 0]}\n",
                "a box and as a ball"},
        Mistake{"  fields:\n    - name: a\n", "world.fields[0].acceleration is missing"},
        Mistake{"  fields:\n    - {name: a, shape: density}\n",
                "world.fields[0].density is missing"},
        Mistake{"  fields:\n    - {name: a, shape: attraction, point: [0, 0, 0], strength: 1}\n",
                "world.fields[0].core is missing"},
        Mistake{"  fields:\n    - {name: a, shape: swirl, axis: [0, 0, 0]}\n",
                "a direction without length"},
        Mistake{"  muscles:\n    - {name: a, strength: 1}\n",
                "world.muscles[0] has neither a bone nor a direction"},
        Mistake{"  muscles:\n    - name: a\n      bone: lower\n      strength: 1\n"
                "      keys: [{time: 0, activation: 2}]\n",
                ":14:36: world.muscles[0].keys[0].activation"}));

}  // namespace sinew::world_test
