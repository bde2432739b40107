// SPDX-License-Identifier: GPL-3.0-or-later
// Which rigid motions of a body nothing restrains.
#include <gtest/gtest.h>

#include <sinew/analysis/free_motion.h>

#include "support/machine.h"

namespace sinew::free_motion_test {

using namespace machine;

std::string free_of(const Machine& machine) {
  const auto free = free_motion(machine.body());
  return free ? free->text() : "held";
}

TEST(FreeMotions, ABodyWithoutSupportsIsFree) {
  EXPECT_NE(free_of(Machine()).find("the body can "), std::string::npos);
}

TEST(FreeMotions, AClampHoldsAll) {
  Machine machine;
  machine.world.supports = {{"clamp", machine.bottom()}};
  EXPECT_EQ(free_of(machine), "held");
}

TEST(FreeMotions, ARollerLeavesSlidingAndTurning) {
  Machine machine;
  machine.world.supports = {{"roller", machine.bottom(), {false, false, true}}};
  EXPECT_NE(free_of(machine), "held");
  const std::uint32_t corner = machine.bottom().front(), other = machine.bottom().back();
  machine.world.supports.push_back({"corner", {corner}, {true, true, false}});
  EXPECT_EQ(free_of(machine), "the body can turn about [0, 0, 1]");
  machine.world.supports.push_back({"other", {other}, {true, false, false}});
  EXPECT_EQ(free_of(machine), "held");
}

TEST(FreeMotions, AHingeLeavesTurningAboutIt) {
  Machine machine;
  machine.world.supports = {{"hinge", ids_where(machine.rest, [&](const Vec3& p) {
                               return p.z() < r && std::abs(p.x() - machine.rest[0].x()) < 0.1 * r;
                             })}};
  EXPECT_EQ(free_of(machine), "the body can turn about [0, 1, 0]");
}

TEST(FreeMotions, EachPartMustBeRestrained) {
  Machine machine;
  const std::size_t whole = machine.rest.size();
  machine.world.supports = {{"clamp", machine.bottom()}};
  for (std::size_t i = 0; i < whole; ++i) machine.rest.push_back(machine.rest[i] + Vec3(1, 0, 0));
  const std::string free = free_of(machine);
  EXPECT_NE(free.find("a part of " + std::to_string(whole) + " particles"), std::string::npos)
      << free;
}

TEST(FreeMotions, BonesHoldAlongTheirSprings) {
  const Settings settings = test::box_scene(25);
  const Points rest = test::fcc_box(5, 5, 25, r);
  Body body = test::make_body(settings, rest);
  EXPECT_FALSE(free_motion(body));
  for (BoneSprings& springs : body.springs) springs.twist = 0;
  ASSERT_TRUE(free_motion(body));
  EXPECT_NEAR(free_motion(body)->axis.z(), 1, 1e-6);
}

}  // namespace sinew::free_motion_test
