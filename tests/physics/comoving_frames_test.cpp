// SPDX-License-Identifier: GPL-3.0-or-later
// Frames between bones divide the rotation of a joint, and bent tissue moves with them.
#include <sinew/physics/lists/comoving_frames.h>

#include <set>

#include <sinew/physics/lists/approach_bounds.h>
#include <sinew/scene/rig.h>

#include "all_steppers.h"

namespace sinew {
namespace {

constexpr double r = 0.01;
constexpr int planes = 41;
const double joint = planes * half_plane_spacing(r) / 2;

/// A bar about two bones, of which the upper one bends and twists against the lower, which moves.
Settings bar_scene(double bend, double twist = 0) {
  Settings settings = test::box_scene(planes);
  KeyDefinition end = test::bend_key(1, bend), moved = test::bend_key(1, 25);
  end.twist = twist;
  moved.twist = 40;
  moved.translation = {0.1, 0.2, -0.1};
  settings.tracks = {test::track("lower", {test::bend_key(0, 0), moved}),
                     test::track("upper", {test::bend_key(0, 0), end})};
  return settings;
}

struct World {
  Body body;
  Motion motion;
  std::vector<std::int32_t> id;

  explicit World(const Settings& settings)
      : body(test::make_body(settings, test::fcc_box(7, 7, planes, r))),
        motion(motion_of(settings, body.skeleton)) {
    for (std::size_t i = 0; i < body.rest.size(); ++i) id.push_back(static_cast<std::int32_t>(i));
  }
  Pose pose(double time) const { return pose_at(body.skeleton, motion, time); }

  /// Where the particles are when the rotation is divided evenly over `zone` (m) about the joint.
  Points bent(const Pose& bones, double zone) const {
    const Eigen::AngleAxisd turn(Mat3(bones[0].turn.transpose() * bones[1].turn));
    Points points;
    for (const Vec3& rest : body.rest) {
      const double share = std::clamp(0.5 + (rest.z() - joint) / zone, 0.0, 1.0);
      const Mat3 by = Eigen::AngleAxisd(share * turn.angle(), turn.axis()).toRotationMatrix();
      points.push_back(bones[1].frame.origin + bones[0].turn * (by * (rest - Vec3(0, 0, joint))));
    }
    return points;
  }

  ComovingFrames comoving_frames(const Pose& bones, const Points& points) const {
    BlockState<double> state(points.size());
    for (std::size_t k = 0; k < points.size(); ++k) state.set_position(k, points[k], Units());
    ComovingFrames made(body);
    made.choose(body, bones, state, Units(), id);
    return made;
  }
};

double angle_of(const Mat3& turn) { return Eigen::AngleAxisd(turn).angle(); }

TEST(ComovingFrames, AreTheBonesAtRest) {
  const World world(bar_scene(90));
  const ComovingFrames comoving_frames = world.comoving_frames(world.pose(0), world.body.rest);
  EXPECT_EQ(comoving_frames.at(world.pose(0)).size(), 2u);
  for (std::size_t k = 0; k < world.id.size(); ++k)
    EXPECT_EQ(comoving_frames.of_particles()[k], world.body.binding.bone(k));
}

TEST(ComovingFrames, DivideTheRotationOfAJoint) {
  const World world(bar_scene(80, 30));
  const Pose bones = world.pose(1);
  const Pose all = world.comoving_frames(bones, world.bent(bones, joint)).at(bones);
  ASSERT_GT(all.size(), 6u);
  const double whole = angle_of(bones[0].turn.transpose() * bones[1].turn);
  double before = 0;
  for (std::size_t c = 2; c < all.size(); ++c) {
    const double from = angle_of(bones[0].turn.transpose() * all[c].turn);
    EXPECT_NEAR(from + angle_of(all[c].turn.transpose() * bones[1].turn), whole, 1e-6);
    EXPECT_GT(from, before);
    before = from;
  }
}

TEST(ComovingFrames, FollowBentTissueCloserThanItsBones) {
  const World world(bar_scene(80, 30));
  const Pose bones = world.pose(1);
  const Points points = world.bent(bones, joint);
  const ComovingFrames comoving_frames = world.comoving_frames(bones, points);
  const Pose all = comoving_frames.at(bones);
  double off_comoving_frame = 0, off_bone = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto off = [&](std::size_t frame) {
      const Vec3 arm = world.body.rest[k] - Vec3(0, 0, joint);
      return (bones[1].frame.origin + all[frame].turn * arm - points[k]).norm();
    };
    off_comoving_frame = std::max(off_comoving_frame, off(comoving_frames.of_particles()[k]));
    off_bone = std::max(off_bone, off(static_cast<std::size_t>(world.body.binding.bone(k))));
  }
  EXPECT_LT(off_comoving_frame, off_bone / 3);
}

TEST(ComovingFrames, MoveAtTheirVelocities) {
  const World world(bar_scene(120, 70));
  const Pose bones = world.pose(0.6);
  const ComovingFrames comoving_frames = world.comoving_frames(bones, world.bent(bones, joint));
  const double h = 1e-5;
  const Pose before = comoving_frames.at(world.pose(0.6 - h)), now = comoving_frames.at(bones),
             after = comoving_frames.at(world.pose(0.6 + h));
  ASSERT_GT(now.size(), 4u);
  for (std::size_t c = 0; c < now.size(); ++c)
    for (const Vec3& at : {Vec3(0, 0, 0), Vec3(0.1, -0.05, 0.3)}) {
      const auto place = [&](const BonePose& pose) {
        return Vec3(pose.frame.origin + pose.frame.rotation * at);
      };
      const Vec3 velocity = (place(after[c]) - place(before[c])) / (2 * h);
      EXPECT_LT((velocity - now[c].velocity_at(place(now[c]))).norm(), 1e-6)
          << "comoving_frame " << c;
    }
}

TEST(ComovingFrames, OfUnboundParticlesIsTheScene) {
  World world(bar_scene(90));
  world.body.binding.first.assign(world.id.size() + 1, 0);
  world.body.binding.influences.clear();
  const Pose bones = world.pose(1);
  const ComovingFrames comoving_frames = world.comoving_frames(bones, world.body.rest);
  for (const std::uint32_t comoving_frame : comoving_frames.of_particles())
    EXPECT_EQ(comoving_frame, comoving_frames.at(bones).size());
}

template <class Real>
void expect_each_lane_once(std::size_t count, std::size_t run) {
  constexpr std::size_t size = kernel::Traits<Real>::block;
  std::vector<std::uint32_t> comoving_frame;
  for (std::size_t k = 0; k < count; ++k)
    comoving_frame.push_back(static_cast<std::uint32_t>(k / run % 5));
  const FrameSlots<Real> slots = frame_slots<Real>(comoving_frame);
  ASSERT_EQ(slots.first.size(), (count + size - 1) / size + 1);
  for (std::size_t k = 0; k < (slots.first.size() - 1) * size; ++k) {
    double sum = 0;
    for (std::uint32_t s = slots.first[k / size]; s < slots.first[k / size + 1]; ++s) {
      const kernel::FrameSlot slot = slots.slots[s];
      const double one =
          slot.lanes < 0 ? 1
                         : static_cast<double>(
                               slots.lanes[static_cast<std::size_t>(slot.lanes) * size + k % size]);
      if (one != 0) {
        ASSERT_EQ(slot.frame, static_cast<std::int32_t>(comoving_frame.at(k)));
      }
      sum += one;
    }
    ASSERT_EQ(sum, k < count ? 1 : 0) << "particle " << k;
  }
}

TEST(FrameSlots, GiveEachParticleItsComovingFrameAndPadsNone) {
  for (const std::size_t count : {1, 16, 37, 200})
    for (const std::size_t run : {1, 3, 16, 50}) {
      expect_each_lane_once<double>(count, run);
      expect_each_lane_once<float>(count, run);
    }
}

TEST(ComovingFrames, LetListsOfATwistedBodyLast) {
  Settings settings = test::box_scene(planes);
  settings.binding.joint_zone = 3;
  settings.binding.twist_stiffness = 6.4;
  settings.tracks = {test::track("upper", {test::twist_key(0, 0), test::twist_key(1, 90)})};
  Simulation simulation = test::make_simulation(settings, test::fcc_box(7, 7, planes, r));
  while (simulation.time() < 1) simulation.step();
  // A quarter turn moves the surface by 5 diameters: with the bones' frames alone that would be a
  // rebuild per 0.9 of them at least.
  EXPECT_LE(simulation.list_counts().rebuilds, 5);
}

}  // namespace
}  // namespace sinew
