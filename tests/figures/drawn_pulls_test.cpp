// SPDX-License-Identifier: GPL-3.0-or-later
// What the view binding shows of a run: springs between particles and bones, from its files alone.
#include <sinew/run/drawn_pulls.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include <sinew/figures/figure_set.h>
#include "figures/drawn_runs.h"
#include "support/expect_error.h"
#include "support/source_dir.h"

namespace sinew::drawn_pulls_test {

const std::string box =
    std::string("body: {mesh: ") + test::source_dir() + "/data/meshes/box.obj, radius: 0.03}\n";

/// The upper bone stretches by half in a tenth of a second.
const std::string stretching = box + R"(skeleton:
  bones:
    - {name: lower, head: [0, 0, 0], tail: [0, 0, 0.34648]}
    - {name: upper, parent: lower, tail: [0, 0, 0.69296]}
motion:
  tracks:
    - {bone: upper, keys: [{time: 0}, {time: 0.1, stretch: 1.5}]}
solver: {duration: 0.1}
output: {interval: 0.05}
)";

const std::string boneless = box + R"(supports: [{name: foot, facing: [0, 0, -1]}]
solver: {duration: 0.05}
output: {interval: 0.05}
)";

/// Volume bound to a bone over its length is its section A, so that stiffness E V0 / A is
/// stiffness E length / count.
double stiffness(const RunFiles& run, const DrawnPull& pull, double relative) {
  const std::vector<std::int32_t>& bones = *run.body.bone;
  const auto bound = static_cast<double>(std::count(bones.begin(), bones.end(), pull.bone));
  const double length = run.skeleton.bones[static_cast<std::size_t>(pull.bone)].length;
  return relative * run.material.young_modulus() * length / bound;
}

/// The upper bone stretches: its axial springs leave only sqrt(E V0 / k) of it behind.
double axial_stiffness(const RunFiles& run, const DrawnPull& pull) {
  const double r = run.body.particles.radius, usual = stiffness(run, pull, 0.64);
  if (pull.bone == 0) return usual;
  const double lag = stretch_lag(run.skeleton.bones[1], r);
  return std::max(usual, run.material.young_modulus() * volume_per_particle(r) / (lag * lag));
}

TEST(DrawnPulls, AreTheSpringsOfAParticleThatIsDisplaced) {
  const TempFolder folder;
  const RunFiles run = open_run(test::run_of_scene(folder, stretching));
  const DrawnPulls pulls(run);
  const FrameState rest = read_frame(run, 0);
  const std::vector<DrawnPull> at_rest = pulls.at(rest);
  for (std::size_t k = 0; k < at_rest.size(); ++k) {
    const DrawnPull& before = at_rest[k];
    EXPECT_LE(before.strongest(), pulls.negligible());
    const Vec3 arm = before.position - before.reference;
    if (arm.norm() < 0.01 || std::abs(arm.z()) > 1e-9) continue;  // on the bone, or beyond its end
    const Vec3 outward = arm.normalized();
    FrameState frame = rest;
    frame.positions[before.particle] += 0.002 * outward + 0.003 * Vec3::UnitZ();
    const DrawnPull pull = pulls.at(frame)[k];
    const Vec3 from = pull.position - pull.reference;
    const double stretched = from.norm() - arm.norm();
    EXPECT_LT((pull.radial + stiffness(run, pull, 1.6) * stretched * from.normalized()).norm(),
              1e-9);
    EXPECT_LT((pull.axial + axial_stiffness(run, pull) * 0.003 * Vec3::UnitZ()).norm(), 1e-9);
    EXPECT_LT(pull.twist.norm(), 1e-9);
    const double angle = radians(10);
    frame.positions[before.particle] =
        before.reference + Eigen::AngleAxisd(angle, Vec3::UnitZ()) * arm;
    const DrawnPull turned = pulls.at(frame)[k];
    EXPECT_NEAR(turned.twist.norm(), stiffness(run, pull, 1.6) * arm.norm() * angle, 1e-9);
    EXPECT_LT(turned.radial.norm(), 1e-9);
  }
}

TEST(DrawnPulls, HoldParticlesAtReferencePointsThatMoveWithTheBone) {
  const TempFolder folder;
  const RunFiles run = open_run(test::run_of_scene(folder, stretching));
  const DrawnPulls pulls(run);
  const std::vector<DrawnPull> before = pulls.at(read_frame(run, 0));
  const std::vector<DrawnPull> after = pulls.at(read_frame(run, 2));
  ASSERT_EQ(before.size(), 36U);
  std::set<std::size_t> particles;
  for (std::size_t k = 0; k < before.size(); ++k) {
    particles.insert(after[k].particle);
    const double from_head = before[k].reference.z() - 0.34648;
    const Vec3 moved(0, 0, 0.34648 + (before[k].bone == 1 ? 1.5 : 1) * from_head);
    EXPECT_LT((after[k].reference - moved).norm(), 1e-9);
  }
  EXPECT_EQ(particles.size(), 36U);
  EXPECT_EQ(DrawnPulls(run, 1u << 20).at(read_frame(run, 0)).size(), run.body.particles.size());
}

TEST(DrawnPulls, AreDrawnAsArrowsOfWhichTheLongestIsTheStrongest) {
  const TempFolder folder;
  DrawnRunOptions options;
  options.presets = {view_preset_named("binding")};
  const std::string path = test::run_of_scene(folder, stretching).path.string();
  const DrawnRun run(path, options);
  const DrawnView& view = run.view_presets().front();
  const Snapshot snapshot = run.snapshot(2, view);
  EXPECT_EQ(snapshot.particles.size(), 36U);
  EXPECT_EQ(snapshot.references.size(), 36U);
  double longest = 0;
  for (const SnapshotArrow& arrow : snapshot.arrows)
    longest = std::max(longest, arrow.along.norm());
  double strongest = 0;
  for (const DrawnPull& pull : view.pulls->at(read_frame(run.files(), 2)))
    strongest = std::max(strongest, pull.strongest());
  EXPECT_NEAR(longest / (0.25 * 0.69296), strongest / view.range.high, 0.1);
  EXPECT_EQ(run.snapshot(0, view).arrows.size(), 0U);
  options.array = "strain";
  test::expect_bad_input([&] { DrawnRun(path, options); }, {"'strain'", "--array"});
  FigureSetOptions figures;
  figures.range = {0, 1};
  test::expect_bad_input([&] { FigureSet({&run}, 0, figures); }, {"no range", "--range"});
}

TEST(DrawnPulls, NeedBones) {
  const TempFolder folder;
  const RunFiles run = open_run(test::run_of_scene(folder, boneless));
  test::expect_bad_input([&] { DrawnPulls{run}; }, {"no particle", "skeleton.bones", "--view"});
}

}  // namespace sinew::drawn_pulls_test
