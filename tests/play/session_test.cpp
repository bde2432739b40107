// SPDX-License-Identifier: GPL-3.0-or-later
// A session steps through its own recording: run as a scene, the recording makes the same steps.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <sinew/core/file.h>
#include <sinew/core/json.h>
#include <sinew/core/parallel.h>
#include <sinew/play/session.h>
#include <sinew/run/simulate.h>
#include <sinew/settings/read_scene.h>

#include "support/expect_error.h"
#include "support/source_dir.h"
#include "support/temp_folder.h"

namespace sinew {
namespace {

const std::string bones = R"(
  bones:
    - {name: lower, head: [0, 0, 0], tail: [0, 0, 0.34648232]}
    - {name: upper, parent: lower, tail: [0, 0, 0.69296465]}
)";
const std::string clip = R"(
motion: {tracks: [{bone: lower, keys: [{time: 0}, {time: 0.3, euler: [0, 20, 0]}]}]}
)";
const std::string around = R"(
loads: [{name: tip, force: [0.5, 0, 0], low: [-1, -1, 0.6], high: [1, 1, 1],
         keys: [{time: 0, factor: 0}, {time: 0.2, factor: 1}]}]
world: {muscles: [{name: arm, bone: upper, strength: 2000, keys: [{time: 0, activation: 0}]}]}
)";

struct Case {
  const char* name;
  std::string body, more;
  double x = 0;  ///< where it stands, m
};
void PrintTo(const Case& one, std::ostream* out) { *out << one.name; }

class Sessions : public testing::TestWithParam<Case> {
 protected:
  Settings scene(const std::string& more = "") const {
    const std::string offset = "offset: [" + std::to_string(GetParam().x) + ", 0, 0]";
    const std::string text = "body: {mesh: " + test::source_dir() +
                             "/data/meshes/box.obj, radius: 0.03, " + offset + GetParam().body +
                             "}\nskeleton:\n  " + offset + bones + GetParam().more + more +
                             "\noutput: {interval: 0.05}\n";
    return scene_from_text(text, "scene.yaml", folder_.path());
  }

  /// The state that a run of a saved recording ends in.
  std::string hash_of_run(const std::filesystem::path& saved, int threads) const {
    const RunFolder folder{folder_.path() / ("run" + std::to_string(threads))};
    std::string record;
    with_threads(threads,
                 [&] { record = simulate(read_scene(saved), folder, {.force = true}).record; });
    return parsed_json<nlohmann::json>(record)["state_hash"];
  }

  void expect_same(Session& session) const {
    const std::string hash = session.hash();
    const auto saved = session.save("saved");
    EXPECT_EQ(session.hash(), hash);
    EXPECT_EQ(hash_of_run(saved, 1), hash);
    EXPECT_EQ(hash_of_run(saved, 2), hash);
  }

  static void advance(Session& session, int keys) {
    for (int k = 0; k < keys; ++k) session.advance();
  }

  TempFolder folder_;
};

TEST_P(Sessions, WithoutAHandPlayTheClip) {
  Session session(scene(), {folder_.path()});
  advance(session, 23);
  expect_same(session);
}

TEST_P(Sessions, AreTheirRecordings) {
  Session session(scene(), {folder_.path()});
  advance(session, 7);
  session.hand().turn(1, Vec3::UnitY(), 0.6, session.ahead());
  advance(session, 9);
  session.knobs().set_gravity({0, 0, -9.81});
  session.knobs().pull(20, session.simulation().particles().position(20) + Vec3(0.05, 0, 0), 20);
  advance(session, 12);
  session.knobs().let_go();
  session.hand().reach(1, {GetParam().x + 0.3, 0.1, 0.5}, session.ahead());
  advance(session, 14);
  expect_same(session);
}

TEST_P(Sessions, GoOnFromThePast) {
  Session session(scene(), {folder_.path()});
  advance(session, 40);
  session.hand().turn(0, Vec3::UnitX(), -0.5, session.ahead());
  session.knobs().pull(20, {GetParam().x + 0.3, 0, 0.3}, 20);
  advance(session, 30);
  const std::string later = session.hash();
  session.go_to(0.5);
  EXPECT_NE(session.hash(), later);
  session.go_to(10);
  EXPECT_EQ(session.hash(), later);
  session.go_to(0.75);
  session.hand().turn(1, Vec3::UnitY(), 0.4, session.ahead());
  session.knobs().set_gravity({1, 0, 0});
  advance(session, 20);
  expect_same(session);
}

TEST_P(Sessions, AreOnDiskWhileTheyGoOn) {
  Session session(scene(), {folder_.path()});
  advance(session, 20);
  session.keep();
  session.hand().turn(1, Vec3::UnitY(), 0.6, session.ahead());
  advance(session, 20);
  session.go_to(0.5);
  advance(session, 5);
  session.keep();
  EXPECT_EQ(hash_of_run(folder_.path() / "session.yaml", 1), session.hash());
}

const std::string held = R"(
supports: [{name: foot, low: [-1, -1, -0.1], high: [1, 1, 0.05],
            keys: [{time: 0}, {time: 1, translation: [0.05, 0, 0]}]}]
world: {obstacles: [{name: wall, shape: plane, point: [0.2, 0, 0], normal: [-1, 0, 0]}]}
)";
const std::string posed = R"(
motion: {begin: pose, tracks: [{bone: lower, keys: [{time: 0, euler: [0, 40, 0]}, {time: 1}]}]}
)";
const std::string bonded = "material: {model: bonded, damping_ratio: 0.1}\n";
INSTANTIATE_TEST_SUITE_P(
    Of, Sessions,
    testing::Values(
        Case{"paper", "", ""}, Case{"clip", "", clip + bonded},
        Case{"around", "", clip + around + "solver: {gravity: [0, 0, -1]}\n"},
        Case{"single", "", "solver: {precision: single}\nmaterial: {model: bonded}\n", 30},
        Case{"random", ", packing: random", bonded},
        Case{"held", ", packing: hcp", held + "material: {model: bonded_volume}\n"},
        Case{"posed", "", posed + bonded},
        Case{"twisted", "",
             "motion: {tracks: [{bone: upper, keys: [{time: 0}, {time: 0.5, twist: 90}]}]}\n" +
                 bonded},
        Case{"yielding", "", clip + "material: {model: bonded, yield_strain: 0.02}\n"}),
    [](const auto& one) { return std::string(one.param.name); });

TEST(SessionsWithoutBones, ArePulled) {
  const TempFolder folder;
  const std::string text = "body: {mesh: " + test::source_dir() +
                           "/data/meshes/box.obj, radius: 0.03}\nmaterial: {model: bonded}\n"
                           "supports: [{name: foot, low: [-1, -1, -0.1], high: [1, 1, 0.05]}]\n";
  Session session(scene_from_text(text, "scene.yaml", folder.path()), {folder.path()});
  for (int k = 0; k < 10; ++k) session.advance();
  session.knobs().pull(60, session.simulation().particles().position(60) + Vec3(0, 0.1, 0), 30);
  for (int k = 0; k < 30; ++k) session.advance();
  EXPECT_GT(session.knobs_now()
                .force(session.time(), positions_by_id(session.simulation().particles()))
                .norm(),
            0.1);
  const RunResult run = simulate(read_scene(session.save("pulled")), {folder.path() / "run"});
  EXPECT_EQ(parsed_json<nlohmann::json>(run.record)["state_hash"], session.hash());
}

/// On a floor that tilts its weight, a body slides away once the floor has become smooth.
TEST(SessionsOnAFloor, ChangeItsFriction) {
  const TempFolder folder;
  const std::string text = "body: {mesh: " + test::source_dir() +
                           "/data/meshes/box.obj, radius: 0.03}\nmaterial: {model: bonded}\n"
                           "solver: {gravity: [-9, 0, 3]}\nworld: {obstacles: [{name: floor, "
                           "shape: plane, friction: 0.8, "
                           "point: [-0.06, 0, 0], normal: [1, 0, 0]}]}\n";
  Session session(scene_from_text(text, "scene.yaml", folder.path()), {folder.path()});
  const auto speed = [&] {
    const Particles& all = session.simulation().particles();
    double sum = 0;
    for (std::size_t i = 0; i < all.size(); ++i) sum += all.velocity(i).z();
    return sum / static_cast<double>(all.size());
  };
  for (int k = 0; k < 30; ++k) session.advance();
  const double before = speed();
  session.knobs().set("friction of floor", 0);
  EXPECT_THROW(session.knobs().set("friction of floor", -1), Error);
  for (int k = 0; k < 30; ++k) session.advance();
  const double free = speed() - before, passed = 28 * session.grid().interval();
  EXPECT_LT(std::abs(before), 0.1);
  EXPECT_NEAR(free, 3 * passed, 0.1 * 3 * passed);  // as it falls along the floor
  const RunResult run = simulate(read_scene(session.save("smooth")), {folder.path() / "run"});
  EXPECT_EQ(parsed_json<nlohmann::json>(run.record)["state_hash"], session.hash());
}

/// Each bone ends where it was to go, no faster than it may, and turns by more than half a turn.
TEST(Hands, TurnAsFarAsAskedAndNoFaster) {
  const std::vector<BoneDefinition> two = {{"a", "", Vec3(0, 0, 0), Vec3(0, 0, 1)},
                                           {"b", "a", {}, Vec3(0, 0, 2)}};
  Hand hand(make_skeleton(two), {});
  BoneKeys keys(2);
  hand.turn(1, Vec3::UnitX(), 1.5 * pi, keys);
  double turned = 0;
  for (int k = 0; k < 200 && !hand.is_there(1, keys); ++k) {
    const BoneKeys next = hand.next(keys, 1.0 / 60);
    const double step = rotation_vector(next[1].rotation * keys[1].rotation.conjugate()).x();
    EXPECT_LE(step, pi / 60 * (1 + 1e-12));
    turned += step;
    keys = next;
  }
  EXPECT_NEAR(turned, 1.5 * pi, 1e-9);
  hand.turn(1, Vec3::UnitX(), pi, keys);
  for (int k = 0; k < 200; ++k) {  // another way before the first has ended
    if (k == 20) hand.turn(1, Vec3(1, 1, 1), 2, keys);
    const BoneKeys next = hand.next(keys, 1.0 / 60);
    const double step = rotation_vector(next[1].rotation * keys[1].rotation.conjugate()).norm();
    EXPECT_LE(step, pi / 60 * (1 + 1e-12));
    keys = next;
  }
  EXPECT_TRUE(hand.is_there(1, keys));
  hand.reach(1, {0, 1.2, 0.8}, keys);
  for (int k = 0; k < 300; ++k) keys = hand.next(keys, 1.0 / 60);
  const Pose pose = pose_of(make_skeleton(two), keys);
  EXPECT_NEAR((pose[1].frame.origin + pose[1].axis() - Vec3(0, 1.2, 0.8)).norm(), 0, 0.02);
  hand.grab();
  hand.aim(0, {1, 0, 0}, keys);
  for (int k = 0; k < 300; ++k) keys = hand.next(keys, 1.0 / 60);
  EXPECT_NEAR((pose_of(make_skeleton(two), keys)[0].axis() - Vec3::UnitX()).norm(), 0, 1e-9);
  EXPECT_TRUE(hand.undo());
  for (int k = 0; k < 300; ++k) keys = hand.next(keys, 1.0 / 60);
  EXPECT_NEAR((pose_of(make_skeleton(two), keys)[1].axis() - pose[1].axis()).norm(), 0, 1e-9);
  EXPECT_FALSE(hand.undo());
}

}  // namespace
}  // namespace sinew
