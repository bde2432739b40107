// SPDX-License-Identifier: GPL-3.0-or-later
// What is written comes back to the last bit; whatever is not a whole checkpoint is refused.
#include <sinew/io/checkpoint.h>

#include <cstring>
#include <random>

#include "support/expect_error.h"
#include "support/scratch.h"

namespace sinew::checkpoint_test {

constexpr std::uint64_t particles = 5;

template <class Columns>
Columns columns() {
  Columns made;
  for (int axis = 0; axis < 3; ++axis)
    for (std::uint64_t k = 0; k < particles; ++k) {
      using Coord = typename std::decay_t<decltype(made.x[0])>::value_type;
      using Real = typename std::decay_t<decltype(made.v[0])>::value_type;
      made.x[axis].push_back(static_cast<Coord>(1000.0 * (axis + 1) / 3 + static_cast<double>(k)));
      made.v[axis].push_back(static_cast<Real>(-0.1 * (axis + 1) * static_cast<double>(k)));
    }
  return made;
}

Checkpoint sample(bool single = false) {
  Checkpoint sample;
  sample.run = {"1.2.3", 7, 8, 9, particles, 1e-4};
  SimulationState& state = sample.state;
  state.steps = 12345678901;
  state.ledger = {0.1, -0.2, 0.3, true};
  state.world_ledger = {0.4, 0, -0.5, true};
  state.held_at_start = 0.6;
  state.kicked = true;
  state.fixed_point_units = {1e-9, {1, 2, 3}, Box(Vec3(-1, -2, -3), Vec3(1, 2, 3)), 0.7};
  state.mean_when_sorted = 44.5;
  state.order = {4, 3, 2, 1, 0};
  if (single)
    state.moving = columns<MovingInSingle>();
  else
    state.moving = columns<MovingInDouble>();
  state.rest_length = {0.1, 0, 0.3};
  state.sliding_pairs = {0, 3, 3, 0};
  state.sliding = {0.1, 0.2, 0.3, -0.1, -0.2, -0.3};
  state.groups = {1, -2, 0.5};
  state.grouping = {0, -1, 0, 0, 1};
  state.regrouping = {3, 0.25, {-1, 0.5}};
  state.limited = {{0, 2, 0, 0, 1}, 7, 0.125, {1, -2, 3}};
  state.guard = {{4, 2, 5, 8}, 8, true, 0.5, 0.75};
  state.pieces = {0, 0, 2, 2, 2};
  state.broken_ends = 6;
  return sample;
}

/// The same in the middle of an increment of a load.
Checkpoint sample_within_increment(bool single) {
  Checkpoint made = sample(single);
  SimulationState begun = made.state;
  begun.steps = 12;
  begun.relaxation.at_rest = 3;
  made.state.begun = std::make_shared<const SimulationState>(begun);
  made.state.relaxation = {3, 40, 50, 2, 0.25, 0.125, 0.5, 1, 2, 3, 4, 5};
  return made;
}

class CheckpointFile : public Scratch {
 protected:
  std::filesystem::path file() const { return folder / "a.bin"; }
  std::string bytes_of(const Checkpoint& checkpoint) const {
    write_checkpoint(file(), checkpoint);
    return text_of(file());
  }
  void expect_refused(const std::string& bytes, const std::vector<std::string>& parts = {}) const {
    put(file(), bytes);
    std::vector<std::string> all{"a.bin: ", "; "};
    all.insert(all.end(), parts.begin(), parts.end());
    test::expect_bad_input([&] { read_checkpoint(file(), particles); }, all);
  }
};

/// With the checksum that its bytes call for: only what it says is wrong.
std::string resealed(std::string bytes) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (std::size_t i = 0; i + 8 < bytes.size(); ++i)
    hash = (hash ^ static_cast<unsigned char>(bytes[i])) * 0x100000001b3ULL;
  std::memcpy(bytes.data() + bytes.size() - 8, &hash, 8);
  return bytes;
}

TEST_F(CheckpointFile, ComesBackToTheLastBit) {
  for (const bool single : {false, true}) {
    const Checkpoint before = sample(single);
    const std::string bytes = bytes_of(before);
    const Checkpoint after = read_checkpoint(file(), particles);
    EXPECT_EQ(after.run, before.run);
    EXPECT_EQ(after.state.steps, before.state.steps);
    EXPECT_EQ(after.state.moving.index(), before.state.moving.index());
    EXPECT_EQ(after.state.order, before.state.order);
    EXPECT_EQ(bytes_of(after), bytes);  // and so does everything else
  }
}

TEST_F(CheckpointFile, IsRefusedCutAtAnyByte) {
  const std::string bytes = bytes_of(sample());
  for (std::size_t size = 0; size < bytes.size(); ++size) expect_refused(bytes.substr(0, size));
  expect_refused(bytes + '\0', {"too long"});
}

TEST_F(CheckpointFile, IsRefusedWithAnyByteFlipped) {
  for (const bool single : {false, true}) {
    const std::string bytes = bytes_of(sample(single));
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      std::string flipped = bytes;
      flipped[i] = static_cast<char>(flipped[i] ^ (1 << i % 8));
      expect_refused(flipped);
    }
  }
}

TEST_F(CheckpointFile, WithARightChecksumAndAnyByteWrongNeverDoesHarm) {
  std::mt19937 random(5);
  const std::string bytes = bytes_of(sample());
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string changed = bytes;
    changed[i] = static_cast<char>(random());
    put(file(), resealed(changed));
    try {
      const Checkpoint read = read_checkpoint(file(), particles);
      EXPECT_LE(read.state.order.size(), bytes.size());
    } catch (const Error& error) {
      EXPECT_EQ(error.exit(), Exit::bad_input);
    }
  }
}

TEST_F(CheckpointFile, KeepsWhereAnIncrementBegan) {
  for (const bool single : {false, true}) {
    const Checkpoint written = sample_within_increment(single);
    write_checkpoint(file(), written);
    const Checkpoint read = read_checkpoint(file(), particles);
    ASSERT_TRUE(read.state.begun);
    EXPECT_EQ(read.state.begun->steps, 12);
    EXPECT_EQ(read.state.begun->relaxation.at_rest, 3);
    EXPECT_EQ(read.state.begun->moving.index(), single ? 1u : 0u);
    EXPECT_EQ(read.state.relaxation.spent, 50);
    EXPECT_EQ(read.state.relaxation.increment, 0.125);
    EXPECT_EQ(bytes_of(read), bytes_of(written));
  }
}

TEST_F(CheckpointFile, OfAnotherVersionMachineOrBodyIsNamed) {
  const std::string bytes = bytes_of(sample());
  std::string other = bytes;
  other[12] = 11;
  expect_refused(resealed(other), {"version 11, not 10"});
  other = bytes;
  std::swap(other[8], other[11]);
  expect_refused(resealed(other), {"byte order"});
  expect_refused("text", {"not a checkpoint"});
  Checkpoint larger = sample();
  larger.run.particles = particles + 1;
  expect_refused(bytes_of(larger), {"run has 6 particles", "body now 5", "--force"});
}

/// A run that goes on must not differ in its bits from one that never stopped.
TEST_F(CheckpointFile, OfAnOlderVersionIsRefusedWithTheSinewThatWroteIt) {
  Checkpoint older = sample();
  older.run.program = "0.4.2";
  std::string bytes = bytes_of(older);
  bytes[12] = 9;
  expect_refused(resealed(bytes), {"version 9, not 10", "sinew '0.4.2'", "--force"});
}

TEST_F(CheckpointFile, ThatPromisesMoreThanThereIsTakesNoMemory) {
  std::string bytes = bytes_of(sample());
  const std::size_t at = bytes.find("order") + 16;
  const std::uint64_t huge = UINT64_MAX / 2;
  std::memcpy(bytes.data() + at, &huge, 8);
  expect_refused(resealed(bytes), {"section is truncated"});
}

TEST_F(CheckpointFile, InTurnLeavesTheOlderOneWhole) {
  Checkpoints checkpoints(folder / "checkpoint");
  std::string complaint;
  EXPECT_FALSE(checkpoints.newest(particles, complaint));
  Checkpoint one = sample();
  for (const std::int64_t steps : {10, 20, 30}) {
    one.state.steps = steps;
    checkpoints.write(one);
  }
  EXPECT_EQ(read_checkpoint(folder / "checkpoint/a.bin", particles).state.steps, 30);
  EXPECT_EQ(read_checkpoint(folder / "checkpoint/b.bin", particles).state.steps, 20);
  Checkpoints later(folder / "checkpoint");
  EXPECT_EQ(later.newest(particles, complaint)->state.steps, 30);
  EXPECT_EQ(complaint, "");
  one.state.steps = 40;
  later.write(one);
  EXPECT_EQ(read_checkpoint(folder / "checkpoint/b.bin", particles).state.steps, 40);
}

/// A body that comes to rest makes no step.
TEST_F(CheckpointFile, OfTheSameStepIsNewerWhereMoreMomentsAreAtRest) {
  for (const bool later_first : {false, true}) {
    Checkpoints checkpoints(folder / (later_first ? "one" : "other"));
    Checkpoint one = sample();
    for (const std::int64_t moments : {later_first ? 3 : 2, later_first ? 2 : 3}) {
      one.state.relaxation.at_rest = moments;
      checkpoints.write(one);
    }
    std::string complaint;
    EXPECT_EQ(checkpoints.newest(particles, complaint)->state.relaxation.at_rest, 3);
  }
}

TEST_F(CheckpointFile, BrokenGivesWayToTheOlderOne) {
  Checkpoints checkpoints(folder);
  Checkpoint one = sample();
  checkpoints.write(one);
  one.state.steps += 5;
  checkpoints.write(one);
  put(folder / "b.bin", "torn");
  std::string complaint;
  EXPECT_EQ(Checkpoints(folder).newest(particles, complaint)->state.steps, one.state.steps - 5);
  EXPECT_TRUE(contains(complaint, "b.bin")) << complaint;
  put(folder / "a.bin", "");
  for (const char* file : {"b.bin", "a.bin"}) {  // to do what the message says leads on
    test::expect_bad_input([&] { Checkpoints(folder).newest(particles, complaint); },
                           {file, "remove the file to go on without it"});
    std::filesystem::remove(folder / file);
  }
  EXPECT_FALSE(Checkpoints(folder).newest(particles, complaint));
}

}  // namespace sinew::checkpoint_test
