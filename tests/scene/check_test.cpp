// SPDX-License-Identifier: GPL-3.0-or-later
// What is doubtful in a scene is said before it runs.
#include <sinew/scene/check.h>
#include <sinew/scene/warnings.h>

#include <gtest/gtest.h>
#include <sinew/settings/read_scene.h>

#include "settings/temp_folder.h"

namespace sinew::check_test {

/// A bar of 0.2 m with a ring of points at each of these heights, capped.
std::string bar(const std::vector<double>& heights) {
  std::string text, faces;
  for (const double z : heights)
    for (const char* corner : {"-.02 -.02", ".02 -.02", ".02 .02", "-.02 .02"})
      text += std::string("v ") + corner + ' ' + std::to_string(z) + '\n';
  const auto quad = [&](int a, int b, int c, int d) {
    for (const int corner : {a, b, c, d})
      faces += (corner == a ? "f " : " ") + std::to_string(corner);
    faces += '\n';
  };
  const int last = static_cast<int>(heights.size()) - 1;
  for (int ring = 0; ring < last; ++ring)
    for (int k = 0; k < 4; ++k)
      quad(4 * ring + k + 1, 4 * ring + (k + 1) % 4 + 1, 4 * ring + (k + 1) % 4 + 5,
           4 * ring + k + 5);
  quad(4, 3, 2, 1);
  quad(4 * last + 1, 4 * last + 2, 4 * last + 3, 4 * last + 4);
  return text + faces;
}

std::vector<std::string> warnings_with(const std::vector<double>& heights,
                                       const std::string& keys) {
  const TempFolder folder;
  folder.write("bar.obj", bar(heights));
  const auto scene = folder.write("scene.yaml",
                                  "body: {mesh: bar.obj, radius: 0.004}\n"
                                  "skeleton:\n"
                                  "  bones:\n"
                                  "    - {name: lower, head: [0, 0, 0], tail: [0, 0, 0.1]}\n"
                                  "    - {name: upper, parent: lower, tail: [0, 0, 0.2]}\n" +
                                      keys);
  const ReadyScene ready = prepare(read_scene(scene));
  return warnings_of(ready.setup, ready.surface.triangles, 0);
}

const std::string bending =
    "motion: {tracks: [{bone: upper, keys: [{time: 0}, {time: 1, axis: [0, 1, 0], angle: 9}]}]}\n";

TEST(SceneWarnings, TellOfASurfaceThatCannotBend) {
  const auto warnings = warnings_with({0, 0.2}, bending);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("8 faces"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[0].find("subdivide"), std::string::npos) << warnings[0];
}

TEST(SceneWarnings, AreSilentWhereItBendsOrNothingMoves) {
  EXPECT_EQ(warnings_with({0, 0.05, 0.1, 0.15, 0.2}, bending), std::vector<std::string>{});
  EXPECT_EQ(warnings_with({0, 0.2}, ""), std::vector<std::string>{});
}

}  // namespace sinew::check_test
