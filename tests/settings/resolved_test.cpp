// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <random>

#include <sinew/settings/read_scene.h>
#include <sinew/settings/row.h>
#include <sinew/settings/sections.h>
#include <sinew/settings/table.h>
#include <sinew/settings/write_scene.h>

#include "settings/small_scene.h"
#include "support/expect_error.h"
#include "support/temp_folder.h"

namespace sinew::resolved_test {

const std::vector<std::string> texts = {
    "lower", "upper arm", "true",  "null", "~",     "none",   "auto", "12", "1/30", "#1",
    "a: b",  "it's",      "\"",    "\\",   "- x",   "[x]",    "{x",   "*a", "&a",   "!t",
    "%",     "@",         " lead", "é",    "a # b", "trail ", "? x",  "<<", "0x1F", "骨"};

/// Settings that the table allows, drawn at random.
class Chance {
 public:
  explicit Chance(unsigned seed) : random_(seed) {}

  int below(int limit) { return std::uniform_int_distribution<int>(0, limit - 1)(random_); }

  double number(const Range& range) {
    const double low = std::isfinite(range.low) ? range.low : -1e3;
    const double high = std::isfinite(range.high) ? range.high : 1e3;
    return high - (high - low) * std::uniform_real_distribution<double>(0, 1)(random_);
  }

  template <class Owner>
  FieldValue value(const Field<Owner>& row) {
    if (!row.absent.empty() && below(2) == 0) return {};
    switch (row.kind) {
      case FieldKind::number:
        return number(row.range);
      case FieldKind::whole:
        return 1 + below(100'000);
      case FieldKind::flag:
        return below(2) == 0;
      case FieldKind::choice:
        return std::string(row.choices[index(row.choices)]);
      case FieldKind::vector:
        return Vec3(number({}), -0.0, number({}) * 1e-20);
      case FieldKind::numbers: {
        std::vector<double> list;
        for (std::size_t i = 0; i < std::max<std::size_t>(row.count, 1); ++i)
          list.push_back(number(row.range));
        return list;
      }
      case FieldKind::pairs: {
        if (below(2) == 0) return std::string(row.choices.front());
        std::vector<NamePair> pairs(1 + index(texts));
        for (NamePair& pair : pairs) pair = {texts[index(texts)], texts[index(texts)]};
        return pairs;
      }
      case FieldKind::path:
        return "../" + texts[index(texts)] + ".obj";
      case FieldKind::text:
        break;
    }
    return texts[index(texts)];
  }

  template <class Owner>
  Owner owner(std::span<const Field<Owner>> rows) {
    Owner drawn;
    for (const auto& row : rows) row.set(drawn, value(row));
    return drawn;
  }

  Settings settings() {
    Settings drawn = owner(settings_table());
    keep_the_peace(drawn);
    for (int i = 0; i <= below(3); ++i) {
      drawn.bones.push_back(owner(bone_fields()));
      drawn.bones.back().limits = owner(limit_fields());
    }
    for (int i = 0; i < below(3); ++i) {
      drawn.bodies.push_back(owner(part_fields()));
      drawn.bodies.back().young_modulus.reset();
      if (drawn.solver.method == Method::static_equilibrium)
        drawn.bodies.back().body.velocity = drawn.bodies.back().body.angular_velocity =
            Vec3::Zero();
    }
    for (int i = 0; i < below(3); ++i) drawn.bound.push_back(owner(bound_fields()));
    for (int i = 0; i < below(3); ++i) {
      drawn.tracks.push_back(owner(track_fields()));
      for (int k = 0; k <= below(3); ++k) drawn.tracks.back().keys.push_back(owner(key_fields()));
    }
    add_machine(drawn);
    if (conflict_with(Feature::groups, features_of(drawn))) drawn.hierarchy.enabled = false;
    if (drawn.motion.preroll || drawn.solver.method == Method::static_equilibrium)
      drawn.motion.begin = Begin::automatic;
    return drawn;
  }

 private:
  PartSettings part() {
    PartSettings drawn;
    if (below(2) == 0) drawn.region = {Vec3(-1, 0, 2), Vec3(0, 1e-3, 3), {}, {}, 0};
    if (below(2) == 0) drawn.point = drawn.normal = Vec3(number({}), 1, -0.0);
    if (below(2) == 0) drawn.facing = Vec3(0, 1, number({}));
    if (below(2) == 0) drawn.component = below(9);
    if (below(2) == 0) drawn.bone = texts[index(texts)];
    if (below(2) == 0) drawn.ids = {0, 1e9};
    drawn.facing_angle = number({0, 180});
    return drawn;
  }

  void add_machine(Settings& drawn) {
    for (int i = 0; i < below(3); ++i) {
      SupportSettings& support = drawn.supports.emplace_back();
      support = {"s" + std::to_string(i), HeldAxes(below(7)), {}, part(), Vec3(number({}), 0, 1)};
      if (below(2) == 0) support.pivot.reset();
      for (int k = 0; k < below(4); ++k)
        support.keys.push_back({1.0 * k, k * Vec3(0, 1, 0.1), Vec3::UnitX(), k * 1e-9});
    }
    for (int i = 0; i < below(3); ++i) {
      LoadSettings& load = drawn.loads.emplace_back();
      load.name = "l" + std::to_string(i);
      load.part = part();
      const int kind = below(4);
      if (kind == 0) load.force = Vec3(0, 0, number({}));
      if (kind == 1) load.traction = Vec3(0, 0, number({}));
      if (kind == 2) load.gravity = Vec3(0, 0, number({}));
      if (kind == 3) load.pressure = number({});
      for (int k = 0; k < below(4); ++k) load.keys.push_back({0.5 * k, number({})});
    }
    for (int i = 0; i < below(3); ++i) drawn.probes.push_back({texts[index(texts)], {}, part()});
    if (drawn.probes.size() == 2) drawn.probes = {{"p", Vec3(0, number({}), 1), {}}};
  }

  template <class List>
  std::size_t index(const List& list) {
    return static_cast<std::size_t>(below(static_cast<int>(list.size())));
  }

  /// Relations between the settings.
  void keep_the_peace(Settings& drawn) {
    drawn.material.relaxation_shares = drawn.material.relaxation_times = std::nullopt;
    drawn.body.radius.reset();
    drawn.body.count.reset();
    if (below(2) == 0)
      drawn.body.radius = 0.01;
    else
      drawn.body.count = 1000;
    if (!drawn.output.arrays.empty()) drawn.output.arrays = "J, stress";
    if (!drawn.output.only.empty()) drawn.output.only = "velocity, force";
    if (!drawn.output.skin.empty()) drawn.output.skin = "none, velocity, stress";
    if (drawn.output.region) drawn.output.region = {-1, 0, 0, 0.5, 1, 2e9};
    if (drawn.hierarchy.free_region) drawn.hierarchy.free_region = {0, -2, -3e5, 0.5, 1, 2};
    if (!is_lattice(drawn.body.packing)) drawn.output.inside_every = 1;
    if (drawn.output.region || drawn.output.inside_every > 1) drawn.output.volume = false;
    if (drawn.material.k1) drawn.material.young_modulus = MaterialOptions().young_modulus;
    if (drawn.material.k2) drawn.material.lambda = MaterialOptions().lambda;
    if (drawn.material.damping_ratio) drawn.material.damping = MaterialOptions().damping;
    if (drawn.material.model == MaterialModel::paper) {
      drawn.material.breaking_strain = drawn.material.fracture_energy = {};
      drawn.material.yield_strain.reset();
    } else {
      if (drawn.material.breaking_strain) drawn.material.fracture_energy.reset();
      drawn.material.cohesion = Cohesion::all;
      if (!drawn.material.yield_strain) drawn.material.preset = MaterialPresetName::none;
      if (below(2) == 0) {
        drawn.material.relaxation_shares = {0.25, 0.5};
        drawn.material.relaxation_times = {0.125, 3};
      }
    }
    drawn.material.rayleigh.reset();
    if (drawn.material.model != MaterialModel::paper && below(2) == 0) {
      drawn.material.rayleigh = {{0.5, 0.25}};
      drawn.material.damping = MaterialOptions().damping;
      drawn.material.damping_ratio.reset();
      drawn.material.damping_form = DampingForm::rigid;
      drawn.hierarchy.enabled = false;
    }
    if (drawn.material.modulus_direction) drawn.body.packing = Packing::fcc;
    drawn.material.isotropic.reset();
    drawn.material.a = 2;
    if (drawn.material.damping_ratio) drawn.material.damping = MaterialOptions().damping;
    if (drawn.material.model != MaterialModel::paper) drawn.material.cohesion = Cohesion::all;
    if (drawn.material.model == MaterialModel::paper && drawn.material.cohesion == Cohesion::all)
      drawn.material.friction = 0;
    if (drawn.material.model == MaterialModel::paper)
      drawn.material.breaking_strain = drawn.material.yield_strain = std::nullopt;
    if (drawn.material.model == MaterialModel::paper || drawn.material.breaking_strain)
      drawn.material.fracture_energy.reset();
    if (drawn.body.packing != Packing::fcc) drawn.material.modulus_direction.reset();
    if (drawn.material.model == MaterialModel::paper || drawn.body.packing != Packing::fcc)
      drawn.material.isotropic.reset();
    if (!is_isotropic(drawn.material, drawn.body.packing)) drawn.material.poisson_ratio = 0.45;
    drawn.material.preset = MaterialPresetName::none;
    drawn.skeleton.file.clear();
    drawn.motion.file.clear();
    drawn.body.forward.reset();
    drawn.skeleton.forward.reset();
    drawn.motion.end = drawn.motion.start + 1;
    drawn.output.interval = std::min(drawn.output.interval, drawn.solver.duration);
    if (drawn.solver.method == Method::dynamic) {
      drawn.solver.residual.reset();
      drawn.solver.static_solver = StaticSolver::automatic;
    } else {
      drawn.body.velocity = drawn.body.angular_velocity = Vec3::Zero();
      drawn.solver.integrator = Integrator::symplectic_euler;
      drawn.solver.time_step.reset();
      drawn.solver.neighbor_search = NeighborSearch::lists;
      drawn.material.friction = 0;
      drawn.binding.twist_form = TwistForm::servo;
    }
    if (drawn.binding.twist_form == TwistForm::open_loop) drawn.binding.max_force.reset();
  }

  std::mt19937 random_;
};

template <class Owner>
void expect_same(std::span<const Field<Owner>> rows, const Owner& one, const Owner& other) {
  for (const auto& row : rows)
    EXPECT_TRUE(row.get(one) == row.get(other))
        << row.name << ": " << scene_text(row.get(one), row.absent) << " came back as "
        << scene_text(row.get(other), row.absent);
}

void expect_same(const Settings& one, const Settings& other) {
  expect_same(settings_table(), one, other);
  ASSERT_EQ(one.bones.size(), other.bones.size());
  for (std::size_t i = 0; i < one.bones.size(); ++i)
    expect_same(bone_fields(), one.bones[i], other.bones[i]);
  for (std::size_t i = 0; i < one.bones.size(); ++i)
    expect_same(limit_fields(), one.bones[i].limits, other.bones[i].limits);
  ASSERT_EQ(one.bodies.size(), other.bodies.size());
  for (std::size_t i = 0; i < one.bodies.size(); ++i)
    expect_same(part_fields(), one.bodies[i], other.bodies[i]);
  ASSERT_EQ(one.materials.size(), other.materials.size());
  for (std::size_t i = 0; i < one.materials.size(); ++i)
    expect_same(material_fields(), one.materials[i], other.materials[i]);
  ASSERT_EQ(one.bound.size(), other.bound.size());
  for (std::size_t i = 0; i < one.bound.size(); ++i)
    expect_same(bound_fields(), one.bound[i], other.bound[i]);
  ASSERT_EQ(one.tracks.size(), other.tracks.size());
  for (std::size_t i = 0; i < one.tracks.size(); ++i) {
    expect_same(track_fields(), one.tracks[i], other.tracks[i]);
    ASSERT_EQ(one.tracks[i].keys.size(), other.tracks[i].keys.size());
    for (std::size_t k = 0; k < one.tracks[i].keys.size(); ++k)
      expect_same(key_fields(), one.tracks[i].keys[k], other.tracks[i].keys[k]);
  }
}

template <class Owner, class Key>
void expect_same_lists(std::span<const Field<Owner>> rows, std::span<const Field<Key>> key_rows,
                       const std::vector<Owner>& one, const std::vector<Owner>& other) {
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    expect_same(rows, one[i], other[i]);
    ASSERT_EQ(one[i].keys.size(), other[i].keys.size());
    for (std::size_t k = 0; k < one[i].keys.size(); ++k)
      expect_same(key_rows, one[i].keys[k], other[i].keys[k]);
  }
}

void expect_same_machines(const Settings& one, const Settings& other) {
  expect_same_lists(support_fields(), place_key_fields(), one.supports, other.supports);
  expect_same_lists(load_fields(), factor_fields(), one.loads, other.loads);
  ASSERT_EQ(one.probes.size(), other.probes.size());
  for (std::size_t i = 0; i < one.probes.size(); ++i)
    expect_same(probe_fields(), one.probes[i], other.probes[i]);
}

TEST(ResolvedScene, ReadsBackAsTheSameSettings) {
  const TempFolder folder;
  for (unsigned seed = 0; seed < 300; ++seed) {
    const Settings settings = Chance(seed).settings();
    const std::string text = resolved_scene(settings, folder.path());
    const Settings again = read_scene(folder.write("scene.yaml", text));
    expect_same(settings, again);
    expect_same_machines(settings, again);
    if (testing::Test::HasFailure()) FAIL() << "seed " << seed << "\n" << text;
  }
}

/// A run that finishes must be measured by what it has written.
TEST(ResolvedScene, OfManyKeysCanBeReadAgain) {
  std::string text =
      "body: {mesh: a.obj, radius: 0.01}\nskeleton:\n  bones:\n    - {name: b0, head: [0, 0, 0], "
      "tail: "
      "[0, 0, 1]}\n";
  for (int bone = 1; bone < 60; ++bone)
    text += "    - {name: b" + std::to_string(bone) + ", parent: b" + std::to_string(bone - 1) +
            ", tail: [0, 0, " + std::to_string(bone + 1) + "]}\n";
  text += "motion:\n  tracks:\n";
  for (int bone = 0; bone < 60; ++bone) {
    text += "    - bone: b" + std::to_string(bone) + "\n      keys:\n";
    for (int key = 0; key < 1000; ++key)
      text +=
          "        - {time: " + std::to_string(key) + ", twist: " + std::to_string(key % 7) + "}\n";
  }
  const Settings settings = scene_from_text(text, "scene", "");
  const std::string resolved = readable_scene(settings, "out/scene.yaml");
  EXPECT_EQ(scene_from_text(resolved, "scene", "out").tracks[59].keys[999].twist, 999 % 7);
}

/// A run whose scene nobody could read would be lost.
TEST(ResolvedScene, ThatIsTooLongIsRefusedBeforeTheRun) {
  Settings settings = scene_from_text(small_scene, "scene", "");
  settings.tracks.resize(1);
  settings.tracks[0].bone = "lower";
  settings.tracks[0].keys.resize(500'000);
  test::expect_bad_input(
      [&] { readable_scene(settings, "out/scene.yaml"); },
      {"could not be read again", "over 67108864); give it fewer bones or keys"});
}

TEST(ResolvedScene, IsTheSameWhenResolvedAgain) {
  const TempFolder folder;
  const auto scene = folder.write("a.yaml", small_scene);
  const std::string once = resolved_scene(read_scene(scene), folder.path());
  const auto again = folder.write("b.yaml", once);
  EXPECT_EQ(resolved_scene(read_scene(again), folder.path()), once);
}

TEST(ResolvedScene, FindsTheMeshFromItsOwnFolder) {
  const TempFolder folder;
  folder.write("box.obj", "o box\n");
  const Settings settings = read_scene(folder.write("scene.yaml", small_scene));
  const auto resolved =
      folder.write("out/run/scene.yaml", resolved_scene(settings, folder.path() / "out/run"));
  EXPECT_TRUE(std::filesystem::exists(read_scene(resolved).body.mesh));
  EXPECT_NE(resolved_scene(settings, folder.path() / "out/run").find("mesh: ../../box.obj"),
            std::string::npos);
}

TEST(ResolvedScene, NamesEveryKeyOfTheTable) {
  const TempFolder folder;
  const Settings settings = read_scene(folder.write("scene.yaml", small_scene));
  const std::string text = resolved_scene(settings, folder.path());
  for (const auto& row : settings_table())
    EXPECT_NE(text.find("\n  " + std::string(row.name) + ": "), text.npos) << row.name;
}

TEST(ResolvedScene, LeavesOutWhatItsRivalReplaces) {
  const TempFolder folder;
  const auto scene = folder.write("scene.yaml", small_scene + "material:\n  k1: 1000\n");
  const std::string text = resolved_scene(read_scene(scene), folder.path());
  EXPECT_NE(text.find("  k1: 1000"), text.npos);
  EXPECT_EQ(text.find("  young_modulus: "), text.npos);
}

TEST(SettingsTable, DefaultsAreAllowed) {
  for (const auto& row : settings_table()) {
    const FieldValue value = row.get(Settings());
    const auto* number = std::get_if<double>(&value);
    EXPECT_TRUE(number == nullptr || row.range.holds(*number)) << row.name;
    EXPECT_FALSE(row.help.empty()) << row.name;
    EXPECT_EQ(row.help.find('\n'), row.help.npos) << row.name;
  }
}

TEST(SettingsTable, RivalsAreInIt) {
  for (const EitherOr& pair : either_or())
    for (const std::string_view path : {pair.first, pair.second})
      EXPECT_EQ(std::count_if(settings_table().begin(), settings_table().end(),
                              [&](const auto& row) {
                                return std::string(row.section) + '.' + std::string(row.name) ==
                                       path;
                              }),
                1)
          << path;
}

}  // namespace sinew::resolved_test
