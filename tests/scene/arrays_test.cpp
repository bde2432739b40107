// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes that hold meshes, bones and motions as arrays give what the same files give.
#include <gtest/gtest.h>

#include <sinew/core/file.h>
#include <sinew/io/single_files.h>
#include <sinew/mesh/mesh_formats.h>
#include <sinew/rig/motion.h>
#include <sinew/run/run_files.h>
#include <sinew/run/simulate.h>
#include <sinew/scene/prepare.h>
#include <sinew/settings/read_scene.h>

#include "mesh/shapes.h"
#include "support/expect_error.h"
#include "support/temp_folder.h"

namespace sinew::arrays_test {

const PolygonSoup bar = shapes::box({-0.05, -0.05, 0}, {0.05, 0.05, 0.3});

/// A bar of arrays alone, which bends and meets a ball.
Settings scene_of_arrays() {
  Settings scene;
  scene.body.mesh = "my bar";
  scene.meshes["my bar"] = bar;
  scene.meshes["my_bar"] = shapes::sphere(0.03, 3, {0.1, 0, 0.3});
  scene.body.radius = 0.013;
  scene.bones = {{"lower", "", Vec3(0, 0, 0), Vec3(0, 0, 0.15)},
                 {"upper", "lower", {}, Vec3(0, 0, 0.3)}};
  const std::array times{0.0, 0.1};
  const std::array turns{Quat::Identity(), Quat(Eigen::AngleAxisd(0.3, Vec3::UnitY()))};
  scene.tracks = {track_of("upper", times, turns)};
  ObstacleSettings ball;
  ball.name = "ball", ball.shape = ObstacleShape::mesh, ball.mesh = "my_bar";
  scene.world.obstacles = {ball};
  scene.solver.duration = 0.1;
  return scene;
}

std::uint64_t last_hash(const RunFolder& folder) {
  const RunFiles run = open_run(folder);
  const FrameState last = read_frame(run, run.frames() - 1);
  return state_hash(particles_at(last.positions, 1, 1));
}

TEST(SceneOfArrays, LeavesFilesThatGiveTheSameRun) {
  const TempFolder folder;
  const RunFolder first{folder.path() / "first"}, again{folder.path() / "again"};
  ASSERT_EQ(simulate(scene_of_arrays(), first).exit, Exit::done);
  ASSERT_EQ(simulate(read_scene(first.scene()), again).exit, Exit::done);
  EXPECT_EQ(last_hash(first), last_hash(again));
  EXPECT_EQ(read_file(first.body()), read_file(again.body()));  // its origin as well
}

TEST(SceneOfArrays, IsReplacedByAnotherRunOfItself) {
  const TempFolder folder;
  const RunFolder run{folder.path() / "run"};
  ASSERT_EQ(simulate(scene_of_arrays(), run).exit, Exit::done);
  const std::uint64_t before = last_hash(run);
  SimulateOptions force;
  force.force = true;
  ASSERT_EQ(simulate(read_scene(run.scene()), run, force).exit, Exit::done);
  EXPECT_EQ(last_hash(run), before);
}

TEST(SceneOfArrays, ReplacesNoMeshesOfOthers) {
  const TempFolder folder;
  std::filesystem::create_directories(folder.path() / "run/meshes");
  const auto mine = folder.write("run/meshes/my_bar.ply", "mine");
  test::expect_bad_input([&] { simulate(scene_of_arrays(), {folder.path() / "run"}); }, {"meshes"});
  EXPECT_EQ(read_file(mine), "mine");
}

TEST(SceneOfArrays, HasItsMeshesAmongTheChecksums) {
  const TempFolder folder;
  ASSERT_EQ(simulate(scene_of_arrays(), {folder.path() / "run"}).exit, Exit::done);
  EXPECT_NE(read_file(folder.path() / "run/checksums.sfv").find("meshes/my_bar.ply"),
            std::string::npos);
}

TEST(SceneOfArrays, IsReadFromPlyWithTheSameBits) {
  const TempFolder folder;
  PolygonSoup soup = bar;
  soup.points[0].x() = -0.1 / 3;
  const auto path = folder.write("bar.ply", ply_text(soup));
  const PolygonSoup read = read_polygons(path.string());
  EXPECT_EQ(read.points, soup.points);
  EXPECT_EQ(read.polygons, soup.polygons);
}

TEST(SceneOfArrays, NamesTheMeshThatIsWrong) {
  Settings scene = scene_of_arrays();
  PolygonSoup broken = bar;
  broken.polygons[2][0] = 99;
  scene.meshes["my bar"] = broken;
  test::expect_bad_input([&] { prepare({scene}); }, {"my bar", "99"});
}

TEST(SceneOfArrays, RefusesRotationsWithoutTimes) {
  const std::array times{0.0};
  const std::array turns{Quat::Identity(), Quat::Identity()};
  test::expect_bad_input([&] { track_of("upper", times, turns); }, {"'upper'", "2 rotations"});
}

}  // namespace sinew::arrays_test
