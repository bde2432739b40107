// SPDX-License-Identifier: GPL-3.0-or-later
// What pictures show of a run, from the files that a run has left.
#include <sinew/run/snapshots.h>

#include <gtest/gtest.h>

#include <sinew/run/figure_set.h>
#include <sinew/run/simulate.h>
#include <sinew/settings/read_scene.h>
#include "expect_error.h"
#include "settings/temp_folder.h"

namespace sinew::snapshots_test {

const std::string source = SINEW_SOURCE_DIR;

/// The box at a coarse radius; its upper bone stretches by half in a tenth of a second.
std::string stretching_scene() {
  return "body: {mesh: " + source + R"(/data/meshes/box.obj, radius: 0.03}
skeleton:
  bones:
    - {name: lower, head: [0, 0, 0], tail: [0, 0, 0.34648]}
    - {name: upper, parent: lower, tail: [0, 0, 0.69296]}
motion:
  tracks:
    - {bone: upper, keys: [{time: 0}, {time: 0.1, stretch: 1.5}]}
solver: {duration: 0.1}
output: {interval: 0.05}
)";
}

TEST(RunSnapshot, ShowsStretchedBonesAsLongAsTheyAre) {
  const TempFolder folder;
  const std::string scene = folder.write("scene.yaml", stretching_scene()).string();
  const RunFolder run_at{folder.path() / "run"};
  ASSERT_EQ(simulate(read_scene(scene), run_at).exit, Exit::done);
  const RunFiles files = open_run(run_at);
  for (const auto& [frame, stretch] : {std::pair(0, 1.0), {1, 1.25}, {2, 1.5}}) {
    const Snapshot snapshot =
        snapshot_of(files, read_frame(files, static_cast<std::size_t>(frame)), 0);
    const SnapshotBone &lower = snapshot.bones.at(0), &upper = snapshot.bones.at(1);
    EXPECT_NEAR((lower.tail - lower.head).norm(), 0.34648, 1e-6);
    EXPECT_NEAR((upper.tail - upper.head).norm(), stretch * 0.34648, 1e-6) << frame;
    EXPECT_LT((upper.head - lower.tail).norm(), 1e-6);
  }
}

TEST(FigureSet, RefusesPicturesThatExceedTheMemory) {
  EXPECT_NO_THROW(check_memory(8192, 8192, 4e9));
  EXPECT_NO_THROW(check_memory(1280, 720, 1e9));
  test::expect_bad_input([] { check_memory(8192, 8192, 1e9); },
                         {"8192 x 8192 pixels", "2.7 GB", "1.0 GB are free", "--width"});
}

}  // namespace sinew::snapshots_test
