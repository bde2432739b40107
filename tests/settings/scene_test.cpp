// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <sinew/rig/motion.h>
#include <sinew/scene/rig.h>
#include <sinew/settings/read_scene.h>

#include "settings/small_scene.h"
#include "support/source_dir.h"
#include "support/temp_folder.h"

namespace sinew::scene_test {

struct SceneTest : testing::Test {
  Settings read(const std::string& text, const std::vector<std::string>& sets = {}) {
    std::vector<Override> overrides;
    for (const std::string& set : sets) overrides.push_back(parse_override(set));
    return read_scene(folder.write("scene.yaml", text), overrides);
  }

  std::string message(const std::string& text, const std::vector<std::string>& sets = {}) {
    try {
      read(text, sets);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }

  TempFolder folder;
};

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != text.npos;
}

TEST_F(SceneTest, WhatIsNotGivenHasItsDefault) {
  const Settings settings = read(small_scene);
  EXPECT_EQ(settings.body.radius, 0.01);
  EXPECT_FALSE(settings.body.count);
  EXPECT_EQ(settings.body.packing, Packing::fcc);
  EXPECT_EQ(settings.material.young_modulus, MaterialOptions().young_modulus);
  EXPECT_EQ(settings.solver.duration, SolverSettings().duration);
  EXPECT_EQ(settings.solver.precision, Precision::binary64);
  EXPECT_EQ(settings.solver.neighbor_search, NeighborSearch::lists);
  EXPECT_TRUE(settings.tracks.empty());
  ASSERT_EQ(settings.bones.size(), 1u);
  EXPECT_EQ(settings.bones[0].tail, Vec3(0, 0, 1));
}

TEST_F(SceneTest, EveryKindOfValueIsRead) {
  const Settings settings = read(small_scene +
                                 "    - name: \"upper # 2\"\n"
                                 "      parent: lower\n"
                                 "      tail: [0, -1.5e-1, +2]\n"
                                 "solver:\n"
                                 "  integrator: velocity_verlet\n"
                                 "  time_step: auto\n"
                                 "  gravity:\n"
                                 "    - 0\n"
                                 "    - 0\n"
                                 "    - -9.81\n"
                                 "  precision: single\n"
                                 "  neighbor_search: cells\n"
                                 "output:\n"
                                 "  double_precision: true\n"
                                 "  interval: 1/30\n");
  EXPECT_EQ(settings.bones[1].name, "upper # 2");
  EXPECT_EQ(settings.bones[1].parent, "lower");
  EXPECT_EQ(settings.bones[1].tail, Vec3(0, -0.15, 2));
  EXPECT_FALSE(settings.bones[1].head);
  EXPECT_EQ(settings.solver.integrator, Integrator::velocity_verlet);
  EXPECT_FALSE(settings.solver.time_step);
  EXPECT_EQ(settings.solver.gravity, Vec3(0, 0, -9.81));
  EXPECT_EQ(settings.solver.precision, Precision::binary32);
  EXPECT_EQ(settings.solver.neighbor_search, NeighborSearch::cells);
  EXPECT_TRUE(settings.output.double_precision);
  EXPECT_EQ(settings.output.interval, 1.0 / 30);
}

TEST_F(SceneTest, NoneIsTheParentOfARoot) {
  std::string text = small_scene;
  text.insert(text.find("      head"), "      parent: none\n");
  EXPECT_EQ(read(text).bones[0].parent, "");
}

TEST_F(SceneTest, EveryValueHasItsPlace) {
  const Settings settings = read(small_scene +
                                 "motion:\n"
                                 "  tracks:\n"
                                 "    - bone: lower\n"
                                 "      keys:\n"
                                 "        - time: 0\n"
                                 "        - time: 1\n"
                                 "          twist: 90\n");
  const std::string file = (folder.path() / "scene.yaml").string();
  const auto place = [&](const char* path) { return settings.places.at(path).text(); };
  EXPECT_EQ(place(""), file);
  EXPECT_EQ(place("body"), file + ":1:1");
  EXPECT_EQ(place("body.mesh"), file + ":2:9");
  EXPECT_EQ(place("skeleton.bones[0].tail"), file + ":8:13");
  EXPECT_EQ(place("motion.tracks[0]"), file + ":11:7");
  EXPECT_EQ(place("motion.tracks[0].keys[1].twist"), file + ":15:18");
  EXPECT_EQ(settings.place("motion.tracks[0].keys[0].twist").text(), file + ":13:11");
  EXPECT_EQ(settings.place("solver.duration").text(), file);
}

TEST_F(SceneTest, AliasesStandForTheirValues) {
  const Settings settings = read(small_scene +
                                 "    - name: upper\n"
                                 "      parent: lower\n"
                                 "      tail: &top [0, 0, 2]\n"
                                 "solver:\n"
                                 "  gravity: *top\n");
  EXPECT_EQ(settings.solver.gravity, Vec3(0, 0, 2));
}

TEST_F(SceneTest, WindowsLinesAndByteOrderMarkAreRead) {
  std::string text = "\xEF\xBB\xBF";
  for (const char c : small_scene) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(read(text).body.radius, 0.01);
}

TEST_F(SceneTest, OldNamesOfKeysCountWithAWarning) {
  const std::string scene = std::string(small_scene) + "hierarchy: {least: 100}\n";
  const Settings old = read(scene), set = read(scene, {"hierarchy.least=200"});
  EXPECT_EQ(old.hierarchy.min_particles, 100);
  EXPECT_EQ(set.hierarchy.min_particles, 200);
  ASSERT_EQ(old.warnings.size(), 1u);
  EXPECT_TRUE(holds(old.warnings[0], "scene.yaml:"));
  EXPECT_TRUE(holds(old.warnings[0], "hierarchy.least is now called hierarchy.min_particles"));
  EXPECT_TRUE(holds(set.warnings.back(), "--set hierarchy.least=200: "));
  EXPECT_TRUE(
      read(std::string(small_scene) + "hierarchy: {min_particles: 100}\n").warnings.empty());
  EXPECT_TRUE(
      holds(message(std::string(small_scene) + "hierarchy: {least: 100, min_particles: 99}\n"),
            "remove one of them"));
}

TEST_F(SceneTest, MeshIsRelativeToTheSceneAndOpensFromHere) {
  folder.write("shapes/box.obj", "o box\n");
  std::string text = small_scene;
  text.replace(text.find("box.obj"), 7, "../shapes/box.obj");
  const Settings settings = read_scene(folder.write("scenes/a.yaml", text));
  EXPECT_TRUE(std::filesystem::exists(settings.body.mesh)) << settings.body.mesh;
}

TEST_F(SceneTest, AbsoluteMeshStaysAsItIs) {
  std::string text = small_scene;
  text.replace(text.find("box.obj"), 7, "/shapes/box.obj");
  EXPECT_EQ(read(text).body.mesh, "/shapes/box.obj");
}

TEST_F(SceneTest, MeshBehindALinkedFolderIsTheOneTheSystemOpens) {
  folder.write("far/away/shapes/box.obj", "o box\n");
  std::string text = small_scene;
  text.replace(text.find("box.obj"), 7, "../shapes/box.obj");
  folder.write("far/away/scenes/a.yaml", text);
  std::filesystem::create_symlink(folder.path() / "far/away/scenes", folder.path() / "scenes");
  const Settings settings = read_scene(folder.path() / "scenes/a.yaml");
  EXPECT_TRUE(std::filesystem::exists(settings.body.mesh)) << settings.body.mesh;
}

TEST_F(SceneTest, OverridesStandInPlaceOfTheScene) {
  const Settings settings = read(small_scene, {"solver.duration=2", "solver.gravity=[0, 0, -9.81]",
                                               "body.packing=hcp", "solver.duration=3"});
  EXPECT_EQ(settings.solver.duration, 3);
  EXPECT_EQ(settings.solver.gravity, Vec3(0, 0, -9.81));
  EXPECT_EQ(settings.body.packing, Packing::hcp);
  EXPECT_EQ(read(small_scene, {"solver.precision=single"}).solver.precision, Precision::binary32);
  EXPECT_EQ(settings.places.at("body.packing").text(), "--set body.packing=hcp");
}

TEST_F(SceneTest, OverridesTakeOutTheirRivals) {
  const Settings by_count = read(small_scene, {"body.count=500"});
  EXPECT_EQ(by_count.body.count, 500);
  EXPECT_FALSE(by_count.body.radius);
  const Settings by_radius = read(small_scene, {"body.count=500", "body.radius=0.02"});
  EXPECT_FALSE(by_radius.body.count);
  EXPECT_EQ(by_radius.body.radius, 0.02);
  EXPECT_EQ(read(small_scene, {"body.count=auto"}).body.radius, 0.01);
  const std::string stiff = small_scene + "material:\n  young_modulus: 5000\n";
  EXPECT_EQ(read(stiff, {"material.k1=1000"}).material.k1, 1000);
  const std::string paper = small_scene + "material:\n  k1: 1000\n";
  EXPECT_FALSE(read(paper, {"material.young_modulus=5000"}).material.k1);
}

TEST_F(SceneTest, OverridesAddSectionsThatAreMissing) {
  EXPECT_EQ(read(small_scene + "output:\n", {"output.encoding=raw"}).output.encoding,
            Encoding::raw);
  EXPECT_EQ(read(small_scene, {"output.encoding=raw"}).output.encoding, Encoding::raw);
}

TEST_F(SceneTest, OverridesReachEntriesOfListsByNameAndByPlace) {
  const std::string loads =
      "loads:\n  - {name: tip, force: [0, 0, 1]}\n  - {name: a.b=c, force: [0, 0, 2]}\n";
  const Settings named =
      read(small_scene + loads, {"loads[tip].force=[1, 0, 0]", "loads[a.b=c].force=[3, 0, 0]",
                                 "skeleton.bones[lower].tail=[0, 0, 2]"});
  EXPECT_EQ(named.loads[0].force.value()[0], 1);
  EXPECT_EQ(named.loads[1].force.value()[0], 3);
  EXPECT_EQ(named.bones[0].tail.value()[2], 2);
  const Settings numbered = read(small_scene + loads, {"loads[1].force=[0, 5, 0]"});
  EXPECT_EQ(numbered.loads[0].force.value()[2], 1);
  EXPECT_EQ(numbered.loads[1].force.value()[1], 5);
  const std::string bodies = "material: {model: bonded}\nbodies:\n  - {mesh: box.obj}\n";
  EXPECT_EQ(read(small_scene + bodies, {"bodies[0].young_modulus=5"}).bodies[0].young_modulus, 5);
}

TEST_F(SceneTest, OverridesOfEntriesThatAreNotThereNameThoseThatAre) {
  const std::string loads =
      "loads:\n  - {name: tip, force: [0, 0, 1]}\n  - {name: top, force: [0, 0, 2]}\n";
  for (const auto& [set, words] : std::vector<std::pair<std::string, std::string>>{
           {"loads[tap].force=[0, 0, 1]", "'loads' has no entry 'tap'; choose from tip, top"},
           {"loads[2].force=[0, 0, 1]", "choose from tip, top"},
           {"loads.force=[0, 0, 1]", "name one of its entries, as loads[...]: tip, top"},
           {"supports[grip].hold=true", "the scene has no list 'supports'"}})
    EXPECT_TRUE(holds(message(small_scene + loads, {set}), words)) << set;
}

TEST_F(SceneTest, WrongOverridesAreNamed) {
  EXPECT_TRUE(holds(message(small_scene, {"body.radius=big"}), "--set body.radius=big: "));
  EXPECT_TRUE(holds(message(small_scene, {"body.raduis=1"}), "did you mean radius?"));
  EXPECT_TRUE(holds(message(small_scene, {"solver.precision=float"}), "double"));
  EXPECT_TRUE(holds(message(small_scene, {"sovler.duration=1"}), "did you mean solver?"));
  EXPECT_TRUE(holds(message(small_scene, {"duration=1"}), "section.key=value"));
  EXPECT_TRUE(holds(message(small_scene, {"solver.duration"}), "section.key=value"));
  EXPECT_TRUE(holds(message(small_scene, {"solver.duration="}), "is empty"));
}

TEST_F(SceneTest, EveryPresetSetsItsValuesAndNamesItsSource) {
  for (const MaterialPreset& preset : material_presets()) {
    const std::string name(preset.name);
    const MaterialOptions found = read(small_scene + "material: {preset: " + name + "}\n").material;
    EXPECT_EQ(found.density, preset.density) << name;
    EXPECT_EQ(found.young_modulus, preset.young_modulus) << name;
    EXPECT_EQ(found.poisson_ratio, preset.poisson_ratio) << name;
    EXPECT_EQ(found.damping_ratio, preset.damping_ratio) << name;
    EXPECT_EQ(found.yield_strain, preset.yield_strain) << name;
    EXPECT_EQ(preset_named(found.preset), &preset) << name;
    // Poisson's ratio must be one that the scene could give itself.
    read(small_scene + "material: {poisson_ratio: " + std::to_string(preset.poisson_ratio) + "}\n");
    EXPECT_FALSE(preset.what.empty() || preset.source.empty()) << name;
  }
  EXPECT_EQ(preset_named(MaterialPresetName::none), nullptr);
}

TEST_F(SceneTest, SiliconesByHardnessHaveGentsModuli) {
  const auto modulus = [&](const char* name) {
    return read(small_scene + "material: {preset: " + name + "}\n").material.young_modulus;
  };
  EXPECT_NEAR(modulus("silicone_20a"), 0.732e6, 1e3);  // Gent (1958), worked out by hand
  EXPECT_NEAR(modulus("silicone_40a"), 1.69e6, 1e4);
  EXPECT_NEAR(modulus("silicone_60a"), 3.61e6, 1e4);
}

TEST_F(SceneTest, RayleighsDampingStandsAlone) {
  const auto complaint = [&](const std::string& keys, const std::string& more = "") {
    return message(small_scene + "material: {" + keys + "}\n" + more);
  };
  const std::string bonded = "model: bonded, rayleigh: [2, 0.001]";
  EXPECT_EQ(read(small_scene + "material: {" + bonded + "}\n").material.rayleigh,
            (std::vector<double>{2, 0.001}));
  EXPECT_FALSE(
      read(small_scene + "material: {" + bonded + ", preset: muscle}\n").material.damping_ratio);
  EXPECT_TRUE(holds(complaint("model: bonded, rayleigh: [2]"), "give [alpha, beta]"));
  EXPECT_TRUE(holds(complaint("model: bonded, rayleigh: [-2, 0]"), ">= 0"));
  EXPECT_TRUE(holds(complaint(bonded + ", damping_ratio: 0.1"), "remove one of the two"));
  EXPECT_TRUE(holds(complaint(bonded + ", damping: 0.1"), "as material.damping does"));
  EXPECT_TRUE(holds(complaint(bonded + ", damping_form: central"), "damping_form rigid"));
  EXPECT_TRUE(holds(complaint("rayleigh: [2, 0]"), "damping_form rigid"));
  EXPECT_TRUE(holds(complaint(bonded, "hierarchy: {enabled: true}\n"), "hierarchy"));
}

TEST_F(SceneTest, BranchesThatRelaxAreCheckedTogether) {
  const auto complaint = [&](const std::string& keys) {
    return message(small_scene + "material: {model: bonded, " + keys + "}\n");
  };
  const Settings good = read(small_scene +
                             "material: {model: bonded, relaxation_shares: [0.3, 0.2], "
                             "relaxation_times: [0.1, 2]}\n");
  EXPECT_EQ(good.material.relaxation_shares, (std::vector<double>{0.3, 0.2}));
  EXPECT_EQ(good.material.relaxation_times, (std::vector<double>{0.1, 2}));
  EXPECT_TRUE(holds(complaint("relaxation_shares: [0.5]"), "a time for each share"));
  EXPECT_TRUE(holds(complaint("relaxation_times: [0.5]"), "a time for each share"));
  EXPECT_TRUE(holds(complaint("relaxation_shares: [0.5], relaxation_times: [1, 2]"), "length"));
  EXPECT_TRUE(
      holds(complaint("relaxation_shares: [0.5, 0.5], relaxation_times: [1, 2]"), "below 1"));
  EXPECT_TRUE(holds(complaint("relaxation_shares: [0.5], relaxation_times: [0]"), "> 0"));
  EXPECT_TRUE(holds(complaint("relaxation_shares: [0], relaxation_times: [1]"), "> 0"));
  EXPECT_TRUE(holds(complaint("relaxation_shares: [.1, .1, .1, .1, .1], "
                              "relaxation_times: [1, 1, 1, 1, 1]"),
                    "four branches"));
  EXPECT_TRUE(
      holds(message(small_scene + "material: {relaxation_shares: [0.5], relaxation_times: [1]}\n"),
            "bonds that relax and the paper's model exclude each other"));
}

TEST_F(SceneTest, OverriddenMeshIsSeenFromHere) {
  EXPECT_EQ(read(small_scene, {"body.mesh=here/box.obj"}).body.mesh, "here/box.obj");
}

TEST_F(SceneTest, KeyInTheWrongPlaceIsSentHome) {
  EXPECT_TRUE(holds(message(small_scene + "duration: 3\n"), "it belongs into solver"));
}

TEST(ShippedScenes, BendAndTwistAreWholeScenes) {
  for (const char* name : {"box_bend", "box_twist"}) {
    const Settings settings =
        read_scene(std::string(test::source_dir() + "/configs/") + name + ".yaml");
    const Skeleton skeleton = skeleton_of(settings);
    const Motion motion = motion_of(settings, skeleton);
    EXPECT_EQ(skeleton.size(), 2u) << name;
    EXPECT_EQ(motion.tracks.size(), 1u) << name;
    EXPECT_EQ(settings.body.radius, 0.01) << name;
    EXPECT_EQ(settings.output.interval, 1.0 / 30) << name;
    EXPECT_NEAR(skeleton.bones[1].tail().z(), 49 * std::sqrt(2) * 0.01, 1e-8) << name;
  }
}

TEST(ShippedScenes, BendTipsTheUpperBoneAndBringsItBack) {
  const Settings settings = read_scene(test::source_dir() + "/configs/box_bend.yaml");
  const Skeleton skeleton = skeleton_of(settings);
  const Motion motion = motion_of(settings, skeleton);
  const auto axis = [&](double time) { return pose_at(skeleton, motion, time)[1].axis(); };
  EXPECT_TRUE(axis(0).isApprox(Vec3::UnitZ()));
  EXPECT_TRUE(axis(1.25).isApprox(Vec3::UnitX()));
  EXPECT_TRUE(axis(settings.solver.duration).isApprox(Vec3::UnitZ()));
}

TEST(ShippedScenes, ArmAndCreatureBeginAndEndAtRest) {
  for (const char* name : {"arm_bend", "creature_walk"}) {
    const Settings settings =
        read_scene(std::string(test::source_dir() + "/configs/") + name + ".yaml");
    const Skeleton skeleton = skeleton_of(settings);
    const Motion motion = motion_of(settings, skeleton);
    const Pose rest = pose_at(skeleton, {}, 0);
    for (const double time : {0.0, settings.solver.duration}) {
      const Pose pose = pose_at(skeleton, motion, time);
      for (std::size_t b = 0; b < skeleton.size(); ++b) {
        EXPECT_TRUE(pose[b].turn.isIdentity(1e-12)) << name << ' ' << skeleton.bones[b].name;
        EXPECT_LT((pose[b].frame.origin - rest[b].frame.origin).norm(), 1e-12) << name;
      }
    }
  }
}

TEST(ShippedScenes, ArmMakesAFist) {
  const Settings settings = read_scene(test::source_dir() + "/configs/arm_bend.yaml");
  const Skeleton skeleton = skeleton_of(settings);
  const Pose fist = pose_at(skeleton, motion_of(settings, skeleton), 1.6);
  const auto points = [&](const std::string& name) {
    for (std::size_t b = 0; b < skeleton.size(); ++b)
      if (skeleton.bones[b].name == name) return fist[b].axis();
    return Vec3(Vec3::Zero());
  };
  EXPECT_TRUE(points("forearm").isApprox(Vec3::UnitZ(), 1e-9));
  for (const char* finger : {"index_tip", "middle_tip", "ring_tip", "little_tip"})
    EXPECT_LT(points(finger).z(), -0.5) << finger;
}

TEST(ShippedScenes, TwistTurnsTheUpperBoneAboutItself) {
  const Settings settings = read_scene(test::source_dir() + "/configs/box_twist.yaml");
  const Skeleton skeleton = skeleton_of(settings);
  const Pose pose = pose_at(skeleton, motion_of(settings, skeleton), settings.solver.duration);
  EXPECT_TRUE(pose[1].axis().isApprox(Vec3::UnitZ()));
  EXPECT_NEAR(pose[1].twist, pi / 2, 1e-12);
  EXPECT_GT(settings.binding.joint_zone, 0);
}

TEST_F(SceneTest, PairsOfNamesAreReadOrAWordInTheirPlace) {
  const auto pass_through = [&](const std::string& value) {
    return read(small_scene + "contact:\n  pass_through: " + value + '\n').contact.pass_through;
  };
  EXPECT_FALSE(read(small_scene).contact.pass_through.any());
  EXPECT_FALSE(pass_through("none").any());
  EXPECT_TRUE(pass_through("auto").automatic);
  const std::vector<NamePair> pairs = {{"hand", "thigh"}, {"a:b", "c, d"}};
  EXPECT_EQ(pass_through("[[hand, thigh], [\"a:b\", \"c, d\"]]").pairs, pairs);
  EXPECT_EQ(read(small_scene, {"contact.pass_through=[[hand, thigh]]"}).contact.pass_through.pairs,
            std::vector<NamePair>(1, pairs[0]));
  for (const char* wrong :
       {"[hand, thigh]", "[[hand]]", "[[hand, thigh, foot]]", "all", "3", "[]"}) {
    const std::string text =
        message(small_scene + "contact:\n  pass_through: " + std::string(wrong) + '\n');
    EXPECT_TRUE(holds(text, "contact.pass_through")) << text;
    EXPECT_TRUE(holds(text, ":10:")) << text;
  }
}

TEST_F(SceneTest, GroupsNeitherPassThroughEachOtherNorAreHeldByLess) {
  const std::string groups = small_scene + "hierarchy: {enabled: true}\n";
  EXPECT_TRUE(holds(message(groups + "contact: {pass_through: auto}\n"), "remove contact.pass"));
  EXPECT_TRUE(holds(message(groups + "binding: {max_force: 1}\n"), "remove binding.max_force"));
  EXPECT_TRUE(holds(message(small_scene + "binding: {max_force: 1, twist_form: open_loop}\n"),
                    "open_loop"));
}

}  // namespace sinew::scene_test
