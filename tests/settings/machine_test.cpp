// SPDX-License-Identifier: GPL-3.0-or-later
// Supports, loads and probes as scenes give them.
#include <gtest/gtest.h>

#include <sinew/settings/read_scene.h>
#include <sinew/settings/write_scene.h>

#include "settings/small_scene.h"
#include "support/expect_error.h"
#include "support/temp_folder.h"

namespace sinew::machine_test {

// Begins in line 9 of the scene.
const std::string everything = R"(supports:
  - name: clamp
    facing: [0, 0, -1]
  - name: grip
    hold: xz
    low: [-1, -1, 0.9]
    high: [1, 1, 1]
    pivot: [0, 0, 1]
    interpolation: linear
    keys:
      - time: 0
      - {time: 1, translation: [0, 0, 0.1], axis: [0, 0, 1], angle: 720}
loads:
  - {name: weight, gravity: [0, 0, -9.81]}
  - {name: hand, force: [1, 0, 0], center: [0, 0, 1], radius: 0.1, ids: [1, 2]}
  - {name: wind, traction: [0, 5, 0], facing: [0, 1, 0], facing_angle: 45}
  - name: water
    pressure: 1000
    point: [0, 0, 0.5]
    normal: [0, 0, -1]
    component: 0
    keys: [{time: 0, factor: 0}, {time: 2, factor: 1}]
  - {name: oil, pressure: 10, axis: [0, 0, 2], axis_point: [0, 0, 1], axis_radius: 0.1, facing_axis: inward}
probes:
  - {name: tip, at: [0, 0, 1]}
  - {name: middle, bone: lower}
)";

Settings read(const std::string& text) {
  const TempFolder folder;
  return read_scene(folder.write("scene.yaml", text));
}

TEST(MachineSettings, HaveAllTheyAreGiven) {
  const Settings settings = read(small_scene + everything);
  ASSERT_EQ(settings.supports.size(), 2U);
  EXPECT_EQ(settings.supports[0].hold, HeldAxes::xyz);
  EXPECT_EQ(settings.supports[1].hold, HeldAxes::xz);
  EXPECT_EQ(settings.supports[1].keys[1].angle, 720);
  ASSERT_EQ(settings.loads.size(), 5U);
  EXPECT_EQ(settings.loads[0].gravity->z(), -9.81);
  EXPECT_EQ(*settings.loads[1].part.ids, (std::vector<double>{1, 2}));
  EXPECT_EQ(settings.loads[2].part.facing_angle, 45);
  EXPECT_EQ(settings.loads[3].keys[0].value, 0);
  EXPECT_EQ(settings.loads[4].part.facing_axis, AxisSide::inward);
  ASSERT_EQ(settings.probes.size(), 2U);
  EXPECT_EQ(settings.probes[0].at, Vec3(0, 0, 1));
  EXPECT_EQ(settings.probes[1].part.bone, "lower");
}

TEST(MachineSettings, BodiesInAMachineNeedNoBones) {
  const std::string without = small_scene.substr(0, small_scene.find("skeleton"));
  EXPECT_TRUE(read(without + "supports:\n  - name: clamp\n").bones.empty());
  test::expect_bad_input([&] { read(without); }, {"skeleton.bones is missing"});
}

struct Mistake {
  std::string text, why;
};

TEST(MachineSettings, MistakesAreNamedWithTheirLine) {
  for (const auto& [text, why] :
       {Mistake{"supports:\n  - hold: x\n", ":10:5: supports[0].name is missing"},
        Mistake{"supports:\n  - {name: a, hold: zx}\n", ":10:21: supports[0].hold is 'zx'"},
        Mistake{"supports:\n  - {name: a}\n  - {name: a}\n", "two of supports are named 'a'"},
        Mistake{"supports:\n  - {name: a, point: [0, 0, 0]}\n", "has half of a plane"},
        Mistake{"supports:\n  - {name: a, low: [0, 0, 0]}\n", "has one corner of a box"},
        Mistake{"supports:\n  - {name: a, facing: [0, 0, 0]}\n", "a direction without length"},
        Mistake{"supports:\n  - {name: a, keys: [{time: 0, translation: [0, 0, 1]}]}\n",
                "the first key of support 'a' is not at rest; begin with a key without"},
        Mistake{"supports:\n  - {name: a, keys: [{time: 1}, {time: 0}]}\n",
                "keys are not in ascending time"},
        Mistake{"loads:\n  - name: a\n", "load 'a' has no kind of load; give one of force"},
        Mistake{"loads:\n  - {name: a, force: [0, 0, 1], pressure: 1}\n",
                "load 'a' has more than one kind of load"},
        Mistake{"supports:\n  - name: a\nloads:\n  - {name: a, pressure: 1}\n",
                "two of supports, loads and springs are named 'a'"},
        Mistake{"probes:\n  - {name: a, at: [0, 0, 0], ids: [1]}\n",
                "probe 'a' has a point and a part; keep one"},
        Mistake{"support:\n  - name: a\n", "unknown key 'support'"}})
    test::expect_bad_input([&] { read(small_scene + text); }, {why});
}

}  // namespace sinew::machine_test
