// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "bench/state_file.h"
#include "support/scratch.h"

namespace sinew::bench {
namespace {

using StateFile = Scratch;

TEST_F(StateFile, GivesEveryBitBack) {
  const Scene scene = scene_of(Condition::twisted, 3000);
  const Particles particles = settled(scene, Condition::twisted);
  const auto path = state_path(folder, Condition::twisted, 3000);
  write_state(path, particles);
  EXPECT_EQ(state_hash(read_state(path, scene)), state_hash(particles));
}

TEST_F(StateFile, OfAnotherBodyOrCutShortIsRefused) {
  const Scene scene = scene_of(Condition::rest, 3000);
  const auto path = state_path(folder, Condition::rest, 3000);
  write_state(path, scene.start);
  EXPECT_THROW(read_state(path, scene_of(Condition::rest, 4000)), Error);
  resize_file(path, file_size(path) - 1);
  EXPECT_THROW(read_state(path, scene), Error);
}

}  // namespace
}  // namespace sinew::bench
