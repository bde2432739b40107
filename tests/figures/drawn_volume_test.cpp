// SPDX-License-Identifier: GPL-3.0-or-later
// The body's volume in pictures: the plane that cuts it, the cut, and lines of stress.
#include <sinew/figures/drawn_volume.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <sinew/io/vtu.h>
#include "figures/drawn_runs.h"
#include "support/expect_error.h"
#include "support/source_dir.h"

namespace sinew::drawn_volume_test {

const Vec3 joint(0, 0, 0.34648);

/// The box at a coarse radius, bonded, with `keys` of its upper bone; two frames after the start.
RunFolder run_of(const TempFolder& folder, const std::string& keys, const std::string& more = "",
                 const std::string& material = "") {
  const std::string scene = std::string("body: {mesh: ") + test::source_dir() +
                            R"(/data/meshes/box.obj, radius: 0.03}
skeleton:
  bones:
    - {name: lower, head: [0, 0, 0], tail: [0, 0, 0.34648]}
    - {name: upper, parent: lower, tail: [0, 0, 0.69296]}
material: {model: bonded)" + material +
                            R"(}
motion:
  tracks:
    - {bone: upper, keys: [{time: 0}, {time: 0.2, )" +
                            keys + R"(}]}
solver: {duration: 0.2}
output: {interval: 0.1)" + more +
                            "}\n";
  return test::run_of_scene(folder, scene);
}

TEST(DrawnPlane, IsThatOfTheBendAndRidesOnTheParent) {
  const TempFolder folder;
  const RunFolder at = run_of(folder, "axis: [0, 1, 0], angle: 60");
  const DrawnRun run(at.path.string(), test::drawn_as("body"));
  for (const std::size_t frame : {0U, 2U}) {
    const CutPlane plane = run.overview().plane->at(read_frame(run.files(), frame));
    EXPECT_LT((plane.point - joint).norm(), 1e-6);
    EXPECT_LT((plane.normal - Vec3(0, -1, 0)).norm(), 1e-6) << "toward the viewer";
  }
}

TEST(DrawnPlane, FacesTheViewerWhereABoneTwists) {
  const TempFolder folder;
  const RunFolder at = run_of(folder, "axis: [0, 0, 1], angle: 60");
  const DrawnRun run(at.path.string(), test::drawn_as("body"));
  const CutPlane plane = run.overview().plane->at(read_frame(run.files(), 0));
  EXPECT_NEAR(plane.normal.z(), 0, 1e-9);
  const Vec3 viewer = three_quarter_view().row(2);
  EXPECT_GT(plane.normal.dot(viewer), 0.9);
}

TEST(DrawnVolume, CutsAtThePlaneThatIsAskedForAndColorsByTheParticles) {
  const TempFolder folder;
  const RunFolder at = run_of(folder, "axis: [0, 1, 0], angle: 30");
  DrawnRunOptions options = test::drawn_as("cut");
  options.array = "J";
  options.plane = CutPlane{{0, 0, 0.2}, {0, 0, 1}};
  const DrawnRun run(at.path.string(), options);
  const Snapshot snapshot = run.snapshot(2, run.view_presets().front());
  const SnapshotCut& cut = snapshot.cut;
  ASSERT_GT(cut.cells.size(), 50U);
  for (const auto& cell : cut.cells) {
    const auto [low, high] = std::minmax_element(
        cell.begin(), cell.end(),
        [&](std::uint32_t a, std::uint32_t b) { return cut.points[a].z() < cut.points[b].z(); });
    EXPECT_LE(cut.points[*low].z(), 0.2);
    EXPECT_GT(cut.points[*high].z(), 0.2);
  }
  ASSERT_EQ(cut.values.size(), cut.points.size());
  const std::vector<double> J = DrawnValues(run.files(), "J").at(2, read_frame(run.files(), 2));
  const auto [low, high] = std::minmax_element(J.begin(), J.end());
  for (const double value : cut.values) {
    EXPECT_GE(value, *low - 1e-12);
    EXPECT_LE(value, *high + 1e-12);
  }
  for (std::size_t i = 0; i < snapshot.surface.points.size(); ++i)
    EXPECT_NEAR(snapshot.skin_sides.at(i), snapshot.surface.points[i].z() - 0.2, 1e-9);
}

TEST(DrawnVolume, RefusesAPlaneThatMissesTheBody) {
  const TempFolder folder;
  const RunFolder at = run_of(folder, "axis: [0, 1, 0], angle: 30");
  DrawnRunOptions options = test::drawn_as("cut");
  options.plane = CutPlane{{0, 0, 5}, {0, 0, 1}};
  test::expect_bad_input([&] { DrawnRun(at.path.string(), options); },
                         {"does not meet the body", "between -0.08", "0.70"});
}

/// The plane is one across all of the bar, so that what is missing of it is what is torn.
TEST(DrawnVolume, LeavesOutTornCells) {
  const TempFolder folder;
  const RunFolder at =
      run_of(folder, "stretch: 1.6", ", bonds: true, volume: true", ", breaking_strain: 0.2");
  const DrawnRun run(at.path.string(), test::drawn_as("cut"));
  const Dataset last = read_vtu(at.path / "volume" / "volume_000002.vtu");
  const std::vector<std::int32_t>& torn = integers(last.cell_columns, "torn");
  std::vector<std::array<std::uint32_t, 4>> whole;
  const CutPlane plane = run.overview().plane->at(read_frame(run.files(), 2));
  const double aside = 1e-3 * run.files().body.particles.radius;
  int left_out = 0;
  for (std::size_t c = 0; c < torn.size(); ++c) {
    std::array<std::uint32_t, 4> cell{};
    int in_front = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      cell[k] = static_cast<std::uint32_t>(last.connectivity[4 * c + k]);
      in_front += plane.distance(last.points[cell[k]]) > aside;
    }
    if (in_front == 0 || in_front == 4) continue;
    left_out += torn[c];
    if (!torn[c]) whole.push_back(cell);
  }
  EXPECT_GT(left_out, 0);
  EXPECT_EQ(run.snapshot(2, run.view_presets().front()).cut.cells, whole);
}

TEST(DrawnVolume, HasLinesOfStressAlongABarThatIsPulled) {
  const TempFolder folder;
  const RunFolder at = run_of(folder, "stretch: 1.2");
  const DrawnRun run(at.path.string(), test::drawn_as("lines"));
  const DrawnView& drawn = run.view_presets().front();
  const Snapshot snapshot = run.snapshot(2, drawn);
  ASSERT_GT(snapshot.curves.size(), 2U);
  double along = 0, length = 0;
  for (const SnapshotCurve& curve : snapshot.curves)
    for (std::size_t i = 1; i < curve.points.size(); ++i) {
      const Vec3 step = curve.points[i] - curve.points[i - 1];
      if (std::min(curve.points[i].z(), curve.points[i - 1].z()) < 0.45) continue;
      along += std::abs(step.z()), length += step.norm();
      EXPECT_GE(curve.values[i], 0.1 * drawn.range.high);
    }
  ASSERT_GT(length, 0);
  EXPECT_GT(along / length, 0.9);
}

TEST(DrawnValues, MeasureStressAsTheRunWritesIt) {
  const TempFolder folder;
  const RunFolder at = run_of(folder, "stretch: 1.2", ", arrays: stress, double_precision: true");
  const RunFiles files = open_run(at);
  const FrameState frame = read_frame(files, 2);
  const DrawnValues written(files, "stress");
  const TempFolder other;
  const RunFolder without = run_of(other, "stretch: 1.2", ", double_precision: true");
  const RunFiles measured_files = open_run(without);
  const DrawnValues measured(measured_files, "stress");
  const std::vector<double> a = written.at(2, frame),
                            b = measured.at(2, read_frame(measured_files, 2));
  ASSERT_EQ(a.size(), b.size());
  const double largest = *std::max_element(a.begin(), a.end());
  EXPECT_GT(largest, 0);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-9 * largest);
}

}  // namespace sinew::drawn_volume_test
