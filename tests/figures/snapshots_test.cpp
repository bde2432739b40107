// SPDX-License-Identifier: GPL-3.0-or-later
// What pictures show of a run, from the files that a run has left.
#include <sinew/figures/snapshots.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/file.h>
#include <sinew/figures/figure_set.h>
#include <sinew/run/measure_run.h>
#include <sinew/run/run_record.h>
#include <nlohmann/json.hpp>
#include "figures/drawn_runs.h"
#include "support/expect_error.h"
#include "support/source_dir.h"

namespace sinew::snapshots_test {

const std::string source = test::source_dir();

/// The box at a coarse radius; its upper bone stretches by half in a tenth of a second.
std::string stretching_scene(bool bonds = false) {
  return "body: {mesh: " + source + R"(/data/meshes/box.obj, radius: 0.03}
skeleton:
  bones:
    - {name: lower, head: [0, 0, 0], tail: [0, 0, 0.34648]}
    - {name: upper, parent: lower, tail: [0, 0, 0.69296]}
motion:
  tracks:
    - {bone: upper, keys: [{time: 0}, {time: 0.1, stretch: 1.5}]}
solver: {duration: 0.1}
output: {interval: 0.05, bonds: )" +
         (bonds ? "true}\nmaterial: {model: bonded}\n" : "false}\n");
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

TEST(RunRanges, AreOnePerQuantityInAllViews) {
  const TempFolder folder;
  const RunFolder at = test::run_of_scene(folder, stretching_scene());
  DrawnRunOptions options;
  for (const char* view : {"section", "cut", "halves", "strain", "body", "particles"})
    options.presets.push_back(view_preset_named(view));
  const DrawnRun all(at.path.string(), options);
  const ValueRange strain = all.view_presets().front().range;
  EXPECT_GT(strain.high, 0.01);
  for (std::size_t view = 0; view < 5; ++view) {
    EXPECT_EQ(all.view_presets()[view].range.low, strain.low) << view;
    EXPECT_EQ(all.view_presets()[view].range.high, strain.high) << view;
  }
  EXPECT_NE(all.view_presets()[5].range.high, strain.high);  // displacement
  EXPECT_EQ(all.ranges().at("strain_eq").high, strain.high);
  EXPECT_EQ(all.ranges().at("displacement").high, all.view_presets()[5].range.high);
}

TEST(RunRanges, ThatARunHasRecordedAreKept) {
  const TempFolder folder;
  const RunFolder at = test::run_of_scene(folder, stretching_scene());
  record_stage(at, "rendering", 1, {{{"strain_eq", {0.25, 4}}}, 3});
  record_stage(at, "measuring", 1, {{{"strain_eq", {0, 1}}, {"J", {0.5, 1.5}}}, 3});
  record_stage(at, "measuring", 1, {{{"D2min", {0, 1}}}, 2});  // of a run that has gone on
  EXPECT_FALSE(recorded_ranges(at).contains("D2min"));
  EXPECT_EQ(recorded_ranges(at).at("strain_eq").high, 4);
  EXPECT_EQ(recorded_ranges(at).at("J").low, 0.5);
  for (const char* view : {"cut", "section", "strain"}) {
    const DrawnRun run(at.path.string(), test::drawn_as(view));
    EXPECT_EQ(run.view_presets().front().range.low, 0.25) << view;
    EXPECT_EQ(run.view_presets().front().range.high, 4) << view;
  }
  EXPECT_EQ(measure_run(open_run(at), {}).playback.ranges.at("strain_eq").high, 4);
}

TEST(RunRanges, AreRecordedOfWholeRunsAlone) {
  for (const char* every : {"1", "2", "3"}) {
    const TempFolder folder;
    std::string scene = stretching_scene();
    scene.replace(scene.find("bonds: false"), 12, "every: " + std::string(every));
    const RunFolder at = test::run_of_scene(folder, scene);
    EXPECT_EQ(open_run(at).frames_run, 3u) << every;
    const std::filesystem::path series = at.path / "surface.pvd";
    std::string rows = read_file(series);
    const std::size_t second = rows.find("<DataSet", rows.find("<DataSet") + 1);
    write_file(series, rows.erase(second, rows.find("</Collection>") - second));
    EXPECT_EQ(open_run(at).frames_run, every == std::string("3") ? 3u : 0u) << every;
  }
}

TEST(RunRanges, OfAnotherFormAreNone) {
  const TempFolder folder;
  const RunFolder at = test::run_of_scene(folder, stretching_scene());
  auto record = read_record(at);
  record["ranges"] = {{"strain_eq", {1, 0}}, {"J", "all"}, {"speed", {0, 2}}, {"D2min", {1}}};
  write_record(at, record);
  const ValueRanges found = recorded_ranges(at);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found.at("speed").high, 2);
  record["ranges"] = "none";
  write_record(at, record);
  EXPECT_TRUE(recorded_ranges(at).empty());
  write_file(at.record(), "{\"program\": ");  // torn: the frames are sound
  EXPECT_TRUE(open_run(at).ranges.empty());
}

TEST(RunViews, OfWhichOneCannotBeDrawnAreTheOthers) {
  const TempFolder folder;
  const RunFolder at = test::run_of_scene(folder, stretching_scene());  // without bonds
  DrawnRunOptions options;
  for (const char* view : {"bonds", "cut"}) options.presets.push_back(view_preset_named(view));
  const DrawnRun run(at.path.string(), options);
  ASSERT_EQ(run.view_presets().size(), 1u);
  EXPECT_EQ(run.view_presets().front().preset.name, "cut");
  ASSERT_EQ(run.left_out().size(), 1u);
  EXPECT_EQ(run.left_out().front().preset, "bonds");
  test::expect_bad_input([&] { DrawnRun(at.path.string(), test::drawn_as("bonds")); }, {});
}

TEST(RunViews, ThatAreCutOpenKeepThePaleSkinAndHideBonesBeforeThePlane) {
  const TempFolder folder;
  const RunFolder at = test::run_of_scene(folder, stretching_scene());
  DrawnRunOptions options = test::drawn_as("cut");
  options.plane = CutPlane{{0, 0, 0.4}, Vec3::UnitZ()};  // through the upper bone below its middle
  const DrawnRun run(at.path.string(), options);
  const Snapshot snapshot = run.snapshot(0, run.view_presets().front());
  EXPECT_TRUE(snapshot.opened);
  ASSERT_EQ(snapshot.bones.size(), 1u);     // the lower one
  EXPECT_TRUE(snapshot.particles.empty());  // no cell is torn
}

TEST(RunSnapshot, SaysAnAngleOnlyOfBones) {
  const TempFolder folder;
  const auto caption = [&](const std::string& scene) {
    const RunFolder run_at{folder.path() / std::to_string(scene.size())};
    EXPECT_EQ(simulate(read_scene(folder.write("scene.yaml", scene).string()), run_at).exit,
              Exit::done);
    const RunFiles files = open_run(run_at);
    return snapshot_of(files, read_frame(files, 1), radians(30)).caption;
  };
  EXPECT_EQ(caption(stretching_scene()), "0.05 s,  30\u00b0");
  EXPECT_EQ(caption("body: {mesh: " + source + "/data/meshes/box.obj, radius: 0.03}\n" +
                    R"(supports: [{name: foot, facing: [0, 0, -1]}]
solver: {duration: 0.05}
output: {interval: 0.05}
)"),
            "0.05 s");
}

TEST(FigureSet, RefusesPicturesThatExceedTheMemory) {
  EXPECT_NO_THROW(check_memory(8192, 8192, 4e9));
  EXPECT_NO_THROW(check_memory(1280, 720, 1e9));
  test::expect_bad_input([] { check_memory(8192, 8192, 1e9); },
                         {"8192 x 8192 pixels", "2.7 GB", "1.0 GB are free", "--width"});
}

/// The bending box with its bonds.
RunFolder bending_run(const TempFolder& folder, bool bonds) {
  return test::run_of_scene(folder, stretching_scene(bonds));
}

TEST(DrawnRun, TracesPickedParticlesUpToTheMoment) {
  const TempFolder folder;
  const RunFolder at = bending_run(folder, false);
  DrawnRunOptions options = test::drawn_as("body");
  options.traced = {0, 40};
  const DrawnRun run(at.path.string(), options);
  const Snapshot snapshot = run.snapshot(1, run.view_presets().front());
  ASSERT_EQ(snapshot.traces.size(), 2U);
  EXPECT_EQ(snapshot.traces[1].label, "40");
  for (std::size_t frame = 0; frame < 2; ++frame)
    EXPECT_EQ(snapshot.traces[1].path.at(frame), read_frame(run.files(), frame).positions[40]);
  EXPECT_EQ(snapshot.traces[1].path.size(), 2U);
  const int count = static_cast<int>(run.files().body.particles.size());
  options.traced = {count};
  test::expect_bad_input([&] { DrawnRun(at.path.string(), options); },
                         {"no particle " + std::to_string(count),
                          "from 0 to " + std::to_string(count - 1), "--trace"});
}

TEST(DrawnRun, DrawsSelectedBonesAndGraysTheParticlesOfOthers) {
  const TempFolder folder;
  const RunFolder at = bending_run(folder, false);
  DrawnRunOptions options = test::drawn_as("body");
  options.bones = {"upper"};
  const DrawnRun run(at.path.string(), options);
  const Snapshot snapshot = run.snapshot(2, run.view_presets().front());
  ASSERT_EQ(snapshot.bones.size(), 1U);
  EXPECT_NEAR((snapshot.bones[0].tail - snapshot.bones[0].head).norm(), 1.5 * 0.34648, 1e-6);
  const auto& bones = *run.files().body.bone;
  int colored = 0;
  for (std::size_t i = 0; i < bones.size(); ++i) {
    EXPECT_EQ(std::isnan(snapshot.values[i]), bones[i] != 1) << i;
    colored += bones[i] == 1;
  }
  EXPECT_GT(colored, 0);
  options.bones = {"uper"};
  test::expect_bad_input([&] { DrawnRun(at.path.string(), options); },
                         {"'uper'", "did you mean upper?"});
}

TEST(DrawnRun, DrawsWrittenBonds) {
  const TempFolder folder;
  const RunFolder at = bending_run(folder, true);
  const DrawnRun run(at.path.string(), test::drawn_as("bonds"));
  const DrawnView& view = run.view_presets().front();
  const Snapshot snapshot = run.snapshot(2, view);
  EXPECT_EQ(view.name(), "strain");
  const Dataset file = read_vtu(at.path / "bonds/bonds_000002.vtu");
  ASSERT_EQ(snapshot.lines.size(), file.cells());
  const std::vector<double>& strain = numbers(file.cell_columns, "strain");
  for (std::size_t k = 0; k < file.cells(); ++k) {
    const SnapshotLine& line = snapshot.lines[k];
    EXPECT_EQ(line.value, strain[k]);
    EXPECT_EQ(line.to, file.points[file.connectivity[2 * k + 1]]);
  }
  EXPECT_GT(view.range.high, 0.05);  // the bar is pulled
}

TEST(DrawnRun, SaysHowBondsAreWritten) {
  const TempFolder folder;
  const RunFolder at = bending_run(folder, false);
  test::expect_bad_input([&] { DrawnRun(at.path.string(), test::drawn_as("bonds")); },
                         {"has not written its bonds", "--set output.bonds=true"});
}

/// The vertices' values of an array by the frames' own, and by the particles of a run that has not
/// written them.
TEST(DrawnRun, ColorsTheSkinByItsOwnArrayOrByThatOfTheParticles) {
  const TempFolder folder, without;
  Settings scene = read_scene(folder.write("scene.yaml", stretching_scene(true)).string());
  const RunFolder with_skin{folder.path() / "run"}, bare{without.path() / "run"};
  ASSERT_EQ(simulate(scene, with_skin).exit, Exit::done);
  scene.output.skin = "none";
  ASSERT_EQ(simulate(scene, bare).exit, Exit::done);
  for (const char* array : {"strain_eq", "strain", "von_mises"}) {
    DrawnRunOptions options = test::drawn_as("surface");
    options.array = array;
    const DrawnRun own(with_skin.path.string(), options), carried(bare.path.string(), options);
    const Snapshot snapshot = own.snapshot(2, own.view_presets().front());
    const Snapshot again = carried.snapshot(2, carried.view_presets().front());
    ASSERT_EQ(snapshot.skin_values.size(), snapshot.surface.points.size());
    const Dataset file = read_vtu(with_skin.path / "surface/surface_000002.vtu");
    const auto& written =
        numbers(file.point_columns, std::string_view(array) == "strain" ? "strain_eq" : array);
    EXPECT_EQ(snapshot.skin_values, written) << array;
    const double largest = *std::max_element(written.begin(), written.end());
    for (std::size_t i = 0; i < written.size(); ++i)
      ASSERT_NEAR(again.skin_values[i], written[i], 1e-3 * largest) << array << ' ' << i;
    EXPECT_GT(own.view_presets().front().range.high, 0);
  }
}

TEST(DrawnRun, ColorsTheSkinByMagnitudesAndWholeNumbersAndOnlyWhereAsked) {
  const TempFolder folder;
  const RunFolder at = bending_run(folder, false);
  DrawnRunOptions options = test::drawn_as("surface");
  const DrawnRun plain(at.path.string(), options);
  EXPECT_TRUE(plain.snapshot(2, plain.view_presets().front()).skin_values.empty());
  options.array = "displacement";
  const DrawnRun moved(at.path.string(), options);
  const Snapshot snapshot = moved.snapshot(2, moved.view_presets().front());
  for (std::size_t i = 0; i < snapshot.skin_values.size(); ++i)
    ASSERT_NEAR(snapshot.skin_values[i],
                (snapshot.surface.points[i] - moved.files().surface.points[i]).norm(), 1e-6);
  options.array = "id";  // the particles' alone
  const DrawnRun ids(at.path.string(), options);
  for (const double id : ids.snapshot(2, ids.view_presets().front()).skin_values)
    ASSERT_EQ(id, std::round(id));
  options.array = "warmth";
  test::expect_bad_input([&] { DrawnRun(at.path.string(), options); },
                         {"'warmth'", "strain_eq", "normal", "force_pair"});
}

TEST(DrawnRun, HalvesTheBodyBetweenSkinAndParticles) {
  const TempFolder folder;
  const RunFolder at = bending_run(folder, false);
  const DrawnRun run(at.path.string(), test::drawn_as("halves"));
  const Snapshot snapshot = run.snapshot(0, run.view_presets().front());
  const Vec3 right = three_quarter_view().row(0);
  const double middle = right.dot(bounds(positions_of(run.files().body.particles)).center());
  for (const Vec3& particle : snapshot.particles) EXPECT_GT(right.dot(particle), middle);
  const double left = static_cast<double>(snapshot.particles.size()) /
                      static_cast<double>(run.files().body.particles.size());
  EXPECT_NEAR(left, 0.5, 0.1);
  EXPECT_EQ(snapshot.values.size(), snapshot.particles.size());
  ASSERT_EQ(snapshot.skin_sides.size(), snapshot.surface.points.size());
  for (std::size_t i = 0; i < snapshot.skin_sides.size(); ++i)
    EXPECT_NEAR(snapshot.skin_sides[i], right.dot(snapshot.surface.points[i]) - middle, 1e-6);
}

}  // namespace sinew::snapshots_test
