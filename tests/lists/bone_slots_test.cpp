// SPDX-License-Identifier: GPL-3.0-or-later
// The kernel's bone forces are those of bone_force.h, wherever particles are relative to their
// bones.
#include <sinew/lists/bone_slots.h>

#include <numeric>

#include <sinew/scene/prepare.h>
#include <sinew/scene/rig.h>

#include "support/all_steppers.h"

namespace sinew::bone_slots_test {

constexpr double r = 0.01;

/// Two bones in the middle of a motion at time 0, with weights that change from one to the other.
Settings moving_scene(double joint_zone = 2) {
  Settings settings = test::box_scene(25);
  settings.binding.joint_zone = joint_zone;
  KeyDefinition begin = test::bend_key(-0.4, 10), end = test::bend_key(0.5, 80);
  end.twist = 200;
  end.translation = {0.1, 0.2, 0.3};
  settings.tracks = {test::track("lower", {test::bend_key(-0.4, -20), test::bend_key(0.5, 60)}),
                     test::track("upper", {begin, end})};
  return settings;
}

struct Scene {
  Settings settings;
  Points rest = test::fcc_box(7, 7, 25, r);
  Body body;
  Pose pose;  ///< at time 0

  explicit Scene(const Settings& given)
      : settings(given),
        body(test::make_body(settings, rest)),
        pose(pose_at(body.skeleton, motion_of(settings, body.skeleton), 0)) {}

  double stiffness() const { return body.springs[0].stiffest() + body.springs[1].stiffest(); }
};

/// Each particle at its place on its leading bone, rotated about that bone by `angle` (degrees), at
/// `ratio` of its distance from the axis and displaced by `slide` along it.
Particles about_their_bones(const Scene& scene, double angle, double ratio, const Vec3& slide) {
  Particles particles = test::shaken(scene.rest, scene.body.material, 0, 0.3);
  for (std::size_t i = 0; i < scene.rest.size(); ++i) {
    const std::size_t lead = scene.body.binding.of(i).front().bone;
    const Bone& bone = scene.body.skeleton.bones[lead];
    const Vec3 local = bone.rest.rotation.transpose() * (scene.rest[i] - bone.head());
    const double turn = radians(angle), c = std::cos(turn), s = std::sin(turn);
    const Vec3 there(local.x(), ratio * (c * local.y() - s * local.z()),
                     ratio * (s * local.y() + c * local.z()));
    const RigidFrame& now = scene.pose[lead].frame;
    particles.set_position(i, now.origin + now.rotation * (there + slide));
  }
  return particles;
}

/// The kernel's forces on particles beside those of bone_force.h: to 1e-12 of the spring forces at
/// the largest distances (single precision 2e-6), and for a particle at a distance rho from its
/// bone, no better than the accuracy of its direction.
void expect_reference_in(Precision precision, const Scene& scene, const Particles& particles,
                         double min_rho = r) {
  Forces expected;
  bone_forces(particles, scene.body, scene.pose, expected);
  const double energy = bone_energy(particles, scene.body, scene.pose);
  double scale = scene.stiffness() * 10 * r;
  for (const Vec3& force : expected.bone) scale = std::max(scale, force.norm());
  const bool doubles = precision == Precision::binary64;
  const double rounding = doubles ? 1e-12 : 2e-6;
  const double blurred = scene.stiffness() * 10 * r * (doubles ? 1e-15 : 1e-9) / min_rho;
  Simulation simulation =
      test::simulation_from(test::in(precision, scene.settings), scene.rest, particles, 1e-3);
  const Points found = simulation.forces().bone;
  for (std::size_t i = 0; i < found.size(); ++i)
    ASSERT_LE((found[i] - expected.bone[i]).norm(), rounding * scale + blurred)
        << "particle " << i << (doubles ? " in doubles" : " in floats");
  EXPECT_NEAR(simulation.energies().bone, energy, rounding * (energy + scale * r));
}

void expect_reference(const Scene& scene, const Particles& particles, double min_rho = r) {
  for (const Precision precision : test::precisions)
    expect_reference_in(precision, scene, particles, min_rho);
}

TEST(BoneSlots, GiveTheForcesOfBonesOnAShakenBody) {
  for (const double zone : {0.0, 2.0}) {
    const Scene scene(moving_scene(zone));
    for (const double shake : {0.1 * r, 0.5 * r}) {
      Particles particles = about_their_bones(scene, 10, 1, {0, 0, 0});
      const Particles by = test::shaken(scene.rest, scene.body.material, shake, 0.3);
      for (std::size_t i = 0; i < particles.size(); ++i)
        particles.set_position(i, particles.position(i) + by.position(i) - scene.rest[i]);
      expect_reference(scene, particles, 1e-3 * r);
    }
  }
}

TEST(BoneSlots, GiveTheForcesOfBonesAtAnyAngle) {
  const Scene scene(moving_scene(0));
  for (const double angle : {0.0, 1e-9, 1e-3, 22.4, 22.6, 45.0, 67.4, 67.6, 90.0, 112.4, 112.6,
                             135.0, 157.4, 157.6, 179.0, 179.999})
    for (const double sign : {-1.0, 1.0}) {
      SCOPED_TRACE(sign * angle);
      expect_reference(scene, about_their_bones(scene, sign * angle, 1, {0, 0, 0}));
      expect_reference(scene, about_their_bones(scene, sign * angle, 1.7, {0.5 * r, 0, 0}));
    }
}

TEST(BoneSlots, GiveTheForcesOfBonesOnBothSidesOfHalfATurn) {
  const Scene scene(moving_scene(0));
  for (const double angle : {179.99999999, -179.99999999})
    expect_reference_in(Precision::binary64, scene,
                        about_their_bones(scene, angle, 1, {0.2 * r, 0, 0}));
}

TEST(BoneSlots, GiveTheForcesOfBonesThroughTheTaperToTheAxis) {
  const Scene scene(moving_scene(0));
  for (const double ratio : {0.7, 0.501, 0.499, 0.4, 0.1, 1e-2, 1e-4, 1e-6})
    for (const double angle : {0.0, 30.0, -100.0, 170.0}) {
      SCOPED_TRACE(ratio);
      expect_reference(scene, about_their_bones(scene, angle, ratio, {0, 0, 0}), ratio * r);
    }
}

TEST(BoneSlots, GiveOppositeTwistsOfOneSizeAtHalfATurn) {
  const Scene scene(moving_scene(0));
  const Particles particles = about_their_bones(scene, 180, 1, {0, 0, 0});
  Forces expected;
  bone_forces(particles, scene.body, scene.pose, expected);
  const Points found =
      test::simulation_from(scene.settings, scene.rest, particles, 1e-3).forces().bone;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Vec3 damping = expected.bone_damping[i];
    EXPECT_NEAR((found[i] - damping).norm(), (expected.bone[i] - damping).norm(),
                1e-12 * scene.stiffness() * 10 * r);
  }
}

TEST(BoneSlots, ParticlesBornOnTheAxisAreNotTwisted) {
  const Scene scene(moving_scene(0));
  int on_axis = 0;
  for (const Vec3& point : scene.rest) on_axis += std::hypot(point.x(), point.y()) < 1e-9 * r;
  ASSERT_GT(on_axis, 10);
  // Displaced across the axis and along it, springs pull them back.
  for (const double aside : {0.0, 1e-3 * r, r})
    expect_reference(scene, about_their_bones(scene, 0, 1, {0.1 * r, aside, 0}), 0.1 * r);
}

TEST(BoneSlots, NonFiniteForcesDoNotComeFromParticlesExactlyOnTheirAxis) {
  const Scene scene(moving_scene());
  const Particles particles = about_their_bones(scene, 0, 0, {0, 0, 0});
  for (const Precision precision : test::precisions) {
    Simulation simulation =
        test::simulation_from(test::in(precision, scene.settings), scene.rest, particles, 1e-3);
    for (const Vec3& force : simulation.forces().bone) ASSERT_TRUE(force.allFinite());
    EXPECT_TRUE(std::isfinite(simulation.energies().bone));
  }
}

template <class Real>
void expect_slots_of_binding(const Scene& scene, const std::vector<std::int32_t>& id) {
  constexpr std::size_t block = kernel::Traits<Real>::block;
  const BoneSlots<Real> slots = bone_slots<Real>(scene.body, id, Units());
  ASSERT_EQ(slots.first.size(), (id.size() + block - 1) / block + 1);
  for (std::size_t k = 0; k < id.size(); ++k) {
    const auto influences = scene.body.binding.of(id[k]);
    double weights = 0, leads = 0;
    std::size_t bound = 0;
    for (std::uint32_t s = slots.first[k / block]; s < slots.first[k / block + 1]; ++s) {
      const kernel::Slot slot = slots.slots[s];
      const auto weight_of = [&](int field) {
        if (slot.weights < 0) return 1.0;
        return static_cast<double>(
            slots.weights[(slot.weights * kernel::weight_fields + field) * block + k % block]);
      };
      weights += weight_of(kernel::weight);
      leads += weight_of(kernel::lead);
      for (const Influence& influence : influences)
        if (influence.bone == slot.bone) {
          ++bound;
          EXPECT_EQ(weight_of(kernel::weight), static_cast<Real>(influence.weight));
        }
    }
    EXPECT_NEAR(weights, 1, 1e-6);
    EXPECT_EQ(leads, 1);
    EXPECT_EQ(bound, influences.size());
  }
}

TEST(BoneSlots, HoldEveryParticleByTheBonesOfItsBindingOnce) {
  const Scene scene(moving_scene());
  std::vector<std::int32_t> id(scene.rest.size());
  std::iota(id.begin(), id.end(), 0);
  for (int order = 0; order < 2; ++order) {
    expect_slots_of_binding<double>(scene, id);
    expect_slots_of_binding<float>(scene, id);
    std::shuffle(id.begin(), id.end(), std::mt19937(4));
  }
}

TEST(BoneSlots, OfParticlesThatNoBoneHoldsAreNone) {
  Scene scene(moving_scene(0));
  Binding& binding = scene.body.binding;  // every other particle has no bone
  Binding loose{{0}, {}, binding.cross_section};
  for (std::size_t i = 0; i < scene.rest.size(); ++i) {
    if (i % 2 == 0) loose.influences.push_back(binding.of(i).front());
    loose.first.push_back(static_cast<std::uint32_t>(loose.influences.size()));
  }
  binding = loose;
  const Motion motion = motion_of(scene.settings, scene.body.skeleton);
  const Particles particles = about_their_bones(Scene(moving_scene(0)), 20, 1, {0, 0, 0});
  Forces expected;
  bone_forces(particles, scene.body, scene.pose, expected);
  for (const Precision precision : test::precisions) {
    const Settings settings = test::in(precision, scene.settings);
    Simulation simulation(scene.body, motion, particles, stepping_of(settings.solver, 1e-4));
    const double rounding = precision == Precision::binary64 ? 1e-12 : 2e-6;
    for (std::size_t i = 0; i < particles.size(); ++i) {
      const Vec3 force = simulation.forces().bone[i];
      ASSERT_TRUE(i % 2 == 0 || force == Vec3::Zero());
      ASSERT_LE((force - expected.bone[i]).norm(), rounding * scene.stiffness() * 100 * r);
    }
  }
}

}  // namespace sinew::bone_slots_test
